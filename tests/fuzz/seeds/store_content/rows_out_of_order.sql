UPDATE meta SET value = '0' WHERE key = 'rows_in_order';
UPDATE meta SET value = '2' WHERE key = 'generation';
