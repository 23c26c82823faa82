UPDATE meta SET value = 'nine' WHERE key = 'class_table';
