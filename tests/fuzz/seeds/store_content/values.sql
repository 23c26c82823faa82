UPDATE segment_state SET iri = 1e300, iri_sd = -1, iri_left = 'x', passes = 1 << 62, flags = 300 WHERE fid = 1;
UPDATE pass SET iri_um = 9223372036854775807, t_ms = -9223372036854775808, occurrence = -1;
UPDATE trip SET t0_utc_ms = 9223372036854775807;
