DELETE FROM way WHERE way_id = 2;
