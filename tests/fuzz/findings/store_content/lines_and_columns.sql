UPDATE segment SET geom = x'4750000300000000', seq = -1, direction = NULL WHERE fid = 2;
UPDATE segment SET geom = zeroblob(100);
UPDATE way SET node_ids = x'00', points = x'7ff8', oneway = 9;
