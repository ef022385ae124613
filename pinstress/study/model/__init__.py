"""From a study to the objects of the rooms: linkage, pins, cases, tasks."""
