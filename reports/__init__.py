"""Reports: from results to tables, plots, VTK files, pictures and a page. Computes no mechanics."""
