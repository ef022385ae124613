"""Reports: results as tables, plots, VTK files, pictures and a page. No mechanics is
computed here.
"""
