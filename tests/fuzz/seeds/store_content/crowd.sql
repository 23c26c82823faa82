UPDATE meta SET value = 'crowd' WHERE key = 'privacy';
INSERT INTO publication VALUES (1, '2026-03', 3, 9, 9, 180, 0, 0, 4, 3);
INSERT INTO published_state SELECT * FROM segment_state;
INSERT INTO published_figure SELECT fid, 1, 1, 1759276800000, 1775001600000, 2000, 100, 1800, 2200, 1900, NULL, 0, 0, 5, 5 FROM segment_state;
PRAGMA writable_schema = ON;
UPDATE sqlite_schema SET sql = replace(sql, 'FROM segment_state', 'FROM published_state') WHERE name = 'roughness';
