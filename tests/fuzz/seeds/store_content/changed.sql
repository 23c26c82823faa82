UPDATE segment_state SET changed = '2026-03-01', changed_ms = 1772352000000, change = -0.5, trend_per_year = 0.1, trend_sd = 0.05;
INSERT INTO strip_state SELECT DISTINCT strip, 4, 3, 1, 0, 12 FROM segment;
INSERT INTO calibration SELECT * FROM calibration;
INSERT INTO forgotten VALUES ('00');
