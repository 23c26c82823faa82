UPDATE meta SET value = 'nan' WHERE key = 'segment_length_m';
DELETE FROM meta WHERE key = 'network_m';
UPDATE meta SET value = 'five' WHERE key = 'class_table';
