UPDATE meta SET value = 'open' WHERE key = 'privacy';
