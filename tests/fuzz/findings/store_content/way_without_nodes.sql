UPDATE way SET node_ids = x'' WHERE way_id = 1;
