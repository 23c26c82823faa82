UPDATE meta SET value = 'crowd' WHERE key = 'privacy';
