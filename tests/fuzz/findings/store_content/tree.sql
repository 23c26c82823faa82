DELETE FROM rtree_segment_geom WHERE id = 3;
UPDATE rtree_segment_geom_node SET data = randomblob(1200);
DELETE FROM segment WHERE fid = 4;
PRAGMA user_version = 1;
PRAGMA journal_mode = WAL;
