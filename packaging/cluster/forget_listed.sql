-- Deletes the trips of a list of marks again, after a database was restored to a moment before they were
-- forgotten (docs/cluster.md). By the owner of the database, before anyone else may connect:
--
--     psql -X postgresql://macadam@HOST/roads -f forget_listed.sql < forgotten.txt
--
-- All values of the chunks that they drove over go, too, until these are fused again. Logs with these trips leave
-- the queue; workers erase those that are stored. If one of the trips calibrated cars, this says that
-- 'macadam calibrate' is needed, as values of other trips rest on it.
\set ON_ERROR_STOP on
BEGIN;
SET LOCAL search_path = pg_catalog, pg_temp;
CREATE TEMP TABLE listed (mark text NOT NULL) ON COMMIT DROP;
\copy listed FROM pstdin
INSERT INTO macadam.forgotten SELECT DISTINCT mark FROM listed ON CONFLICT DO NOTHING;

CREATE TEMP TABLE leaving ON COMMIT DROP AS
    SELECT id, calibrates FROM macadam.trip WHERE encode(sha256(convert_to('macadam forgot ' || sha256, 'UTF8')), 'hex')
        IN (SELECT mark FROM macadam.forgotten);
CREATE TEMP TABLE touched ON COMMIT DROP AS
    SELECT segment.cell, segment.chunk, segment.fid FROM macadam.segment
    WHERE (segment.cell, segment.chunk) IN
        (SELECT cell, chunk FROM macadam.drive WHERE trip IN (SELECT id FROM leaving));

-- As end_forgotten_jobs() of storage/jobs/job_queue.cpp, with the expression of its indexes.
CREATE TEMP TABLE ending ON COMMIT DROP AS
    SELECT job AS log FROM macadam.forgotten JOIN macadam.job_trip
        ON encode(sha256(('macadam forgot ' || trip)::bytea), 'hex') = mark
    UNION SELECT sha256 FROM macadam.forgotten JOIN macadam.job
        ON encode(sha256(('macadam forgot ' || sha256)::bytea), 'hex') = mark;
UPDATE macadam.job SET state = 'known', finished_at = now(), lease_until = NULL, worker = NULL, has_object = true,
    not_before = now(), reason = 'permanently deleted' WHERE sha256 IN (SELECT log FROM ending);
DELETE FROM macadam.job_trip WHERE job IN (SELECT log FROM ending);

INSERT INTO macadam.chunk_dirty (chunk, since_ms)
    SELECT DISTINCT chunk, (1000 * extract(epoch FROM now()))::bigint FROM touched ON CONFLICT DO NOTHING;
DELETE FROM macadam.state_change WHERE segment IN (SELECT fid FROM touched);
DELETE FROM macadam.segment_state WHERE (cell, fid) IN (SELECT cell, fid FROM touched);
DELETE FROM macadam.chunk_state WHERE chunk IN (SELECT chunk FROM touched);
DELETE FROM macadam.drive WHERE trip IN (SELECT id FROM leaving);
DELETE FROM macadam.event WHERE trip IN (SELECT id FROM leaving);
DELETE FROM macadam.event_search WHERE trip IN (SELECT id FROM leaving);
DELETE FROM macadam.row_reason WHERE trip IN (SELECT id FROM leaving);
DELETE FROM macadam.published_pending WHERE trip IN (SELECT id FROM leaving);
DELETE FROM macadam.trip WHERE id IN (SELECT id FROM leaving);
DELETE FROM macadam.calibration WHERE vehicle NOT IN (SELECT vehicle FROM macadam.trip WHERE vehicle IS NOT NULL);
DELETE FROM macadam.calibration_period WHERE vehicle NOT IN (SELECT vehicle FROM macadam.trip WHERE vehicle IS NOT NULL);
DELETE FROM macadam.vehicle WHERE id NOT IN (SELECT vehicle FROM macadam.trip WHERE vehicle IS NOT NULL);
UPDATE macadam.meta SET value = gen_random_uuid()::text WHERE key = 'store_rows'; -- copies that readers keep are fetched anew
INSERT INTO macadam.audit (at, generation, what, detail)
    SELECT to_char(now() AT TIME ZONE 'UTC', 'YYYY-MM-DD"T"HH24:MI:SS"Z"'),
           (SELECT value::bigint FROM macadam.meta WHERE key = 'generation'), 'forget',
           'trips: ' || count(*) || ', listed, after a restore' FROM leaving;
SELECT count(*) AS "trips deleted again" FROM leaving;
SELECT count(*) AS "logs that leave the queue" FROM ending;
SELECT count(*) AS calibrating, count(*) > 0 AS calibrated FROM leaving WHERE calibrates <> 0 \gset
COMMIT;
\if :calibrated
    \echo 'Cars were calibrated from' :calibrating 'of these trips: run ''macadam calibrate'' on the database'
\endif
