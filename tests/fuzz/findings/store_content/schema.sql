DROP VIEW roughness;
ALTER TABLE segment_state RENAME TO hidden;
CREATE VIEW segment_state AS SELECT * FROM hidden;
ALTER TABLE way ADD COLUMN lanes INTEGER;
DROP TABLE trip;
