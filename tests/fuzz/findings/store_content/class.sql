UPDATE meta SET value = 'none' WHERE key = 'class_table';
