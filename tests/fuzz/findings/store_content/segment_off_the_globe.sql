UPDATE segment SET geom = (SELECT geom FROM segment WHERE fid = 1) || x'00' WHERE fid = 3;
