UPDATE meta SET value = '0' WHERE key = 'segment_length_m';
