"""Commands on what a run is made of: scenarios, robots, filters and laws."""
