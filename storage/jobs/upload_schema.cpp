#include "storage/jobs/upload_schema.hpp"

#include "storage/postgres/role_grants.hpp"

namespace macadam {
namespace {

// Who takes uploads reads tokens; only operators make them. An invitation is accepted by a function
// of the owner's, so that a server need not be able to make tokens of any scope.
constexpr const char* tables = R"sql(
CREATE TABLE IF NOT EXISTS macadam.token (
    id text PRIMARY KEY CHECK (id ~ '^[0-9a-f]{8}$'),
    secret_sha256 text NOT NULL CHECK (secret_sha256 ~ '^[0-9a-f]{64}$'),
    owner text NOT NULL CHECK (owner <> ''),
    scope text NOT NULL CHECK (scope IN ('upload', 'read', 'operator')),
    created_ms bigint NOT NULL,
    expires_ms bigint NOT NULL
);
CREATE INDEX IF NOT EXISTS token_owner ON macadam.token (owner);
COMMENT ON TABLE macadam.token IS 'Tokens by which others send logs to a server, or read it';
COMMENT ON COLUMN macadam.token.id IS 'First part of the token';
COMMENT ON COLUMN macadam.token.secret_sha256 IS 'SHA-256 of its second part, 256 random bits that are kept nowhere';
COMMENT ON COLUMN macadam.token.owner IS 'Whose it is; tokens of one name share their logs';
COMMENT ON COLUMN macadam.token.scope IS 'upload: sends logs, sees and deletes its own; read: reads a server; operator: all';
COMMENT ON COLUMN macadam.token.created_ms IS 'Made, ms since 1970 UTC';
COMMENT ON COLUMN macadam.token.expires_ms IS 'Expires, ms since 1970 UTC';
COMMENT ON INDEX macadam.token_owner IS 'Tokens of one name';

CREATE TABLE IF NOT EXISTS macadam.invite (
    id text PRIMARY KEY CHECK (id ~ '^[0-9a-f]{8}$'),
    secret_sha256 text NOT NULL CHECK (secret_sha256 ~ '^[0-9a-f]{64}$'),
    owner text NOT NULL CHECK (owner <> ''),
    expires_ms bigint NOT NULL,
    token_expires_ms bigint NOT NULL
);
COMMENT ON TABLE macadam.invite IS 'Invitations, by each of which somebody gets a token of scope upload once';
COMMENT ON COLUMN macadam.invite.id IS 'First part of the invitation';
COMMENT ON COLUMN macadam.invite.secret_sha256 IS 'SHA-256 of its second part';
COMMENT ON COLUMN macadam.invite.owner IS 'Owner of the token';
COMMENT ON COLUMN macadam.invite.expires_ms IS 'Expires, ms since 1970 UTC';
COMMENT ON COLUMN macadam.invite.token_expires_ms IS 'Until when the token is valid, ms since 1970 UTC';

CREATE TABLE IF NOT EXISTS macadam.token_version (
    number bigint NOT NULL
);
INSERT INTO macadam.token_version SELECT 1 WHERE NOT EXISTS (SELECT FROM macadam.token_version);
COMMENT ON TABLE macadam.token_version IS 'Version of the tokens: servers ask for it several times a second, and read them anew when it has changed';
COMMENT ON COLUMN macadam.token_version.number IS 'Grows with each change of tokens and invitations';
CREATE OR REPLACE FUNCTION macadam.note_token_change() RETURNS trigger
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $$
BEGIN
    UPDATE macadam.token_version SET number = number + 1;
    RETURN NULL;
END $$;
REVOKE ALL ON FUNCTION macadam.note_token_change() FROM PUBLIC;
COMMENT ON FUNCTION macadam.note_token_change() IS 'Lets servers read the tokens anew';
CREATE OR REPLACE TRIGGER changed AFTER INSERT OR UPDATE OR DELETE OR TRUNCATE ON macadam.token
    FOR EACH STATEMENT EXECUTE FUNCTION macadam.note_token_change();
CREATE OR REPLACE TRIGGER changed AFTER INSERT OR UPDATE OR DELETE OR TRUNCATE ON macadam.invite
    FOR EACH STATEMENT EXECUTE FUNCTION macadam.note_token_change();

CREATE OR REPLACE FUNCTION macadam.take_invite(invite_id text, invite_sha256 text, token_sha256 text, now_ms bigint)
RETURNS text LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $$
DECLARE
    taken macadam.invite;
BEGIN
    SELECT * INTO taken FROM macadam.invite
        WHERE id = invite_id AND secret_sha256 = invite_sha256 AND expires_ms > now_ms FOR UPDATE;
    IF NOT FOUND THEN
        RETURN 'none';
    ELSIF EXISTS (SELECT FROM macadam.token WHERE owner = taken.owner AND scope <> 'upload') THEN
        RETURN 'other scope';
    END IF;
    DELETE FROM macadam.token WHERE id = invite_id AND owner = taken.owner;
    IF NOT FOUND THEN -- again within ten minutes, for a phone that the token did not reach
        UPDATE macadam.invite SET expires_ms = least(expires_ms, now_ms + 600000) WHERE id = invite_id;
    END IF;
    INSERT INTO macadam.token VALUES (invite_id, token_sha256, taken.owner, 'upload', now_ms, taken.token_expires_ms);
    DELETE FROM macadam.invite WHERE expires_ms <= now_ms;
    RETURN 'taken';
END $$;
REVOKE ALL ON FUNCTION macadam.take_invite(text, text, text, bigint) FROM PUBLIC;
COMMENT ON FUNCTION macadam.take_invite(text, text, text, bigint) IS 'Makes a token, with its id, for who has an invitation';

ALTER TABLE macadam.job ADD COLUMN IF NOT EXISTS owner text, ADD COLUMN IF NOT EXISTS deleting boolean NOT NULL DEFAULT false;
CREATE INDEX IF NOT EXISTS job_owner ON macadam.job (owner, number) WHERE owner IS NOT NULL;
CREATE INDEX IF NOT EXISTS job_latest ON macadam.job (number);
CREATE INDEX IF NOT EXISTS job_deleting ON macadam.job (number) WHERE deleting;
COMMENT ON COLUMN macadam.job.owner IS 'Owner of the token by which it was sent to a server; NULL: it was submitted';
COMMENT ON COLUMN macadam.job.deleting IS 'Whether its trips are to be deleted, once it is worked out';
COMMENT ON INDEX macadam.job_owner IS 'Logs of one owner, in order';
COMMENT ON INDEX macadam.job_latest IS 'All logs, in order';
COMMENT ON INDEX macadam.job_deleting IS 'Logs whose trips are to be deleted';
ALTER TABLE macadam.job_trip ADD COLUMN IF NOT EXISTS imported boolean NOT NULL DEFAULT false;
COMMENT ON COLUMN macadam.job_trip.imported IS 'Whether it was imported from this log, and not known before: then it goes with the log';
UPDATE macadam.job_trip SET imported = true FROM macadam.job
    WHERE job.sha256 = job_trip.job AND job.state = 'imported';
)sql";

} // namespace

std::string upload_schema() {
    return tables +
           granting("SELECT ON macadam.token, macadam.invite, macadam.token_version",
                    {"macadam_importer", "macadam_operator"}) +
           granting("INSERT, UPDATE, DELETE ON macadam.token, macadam.invite",
                    {"macadam_operator"}) +
           granting("EXECUTE ON FUNCTION macadam.take_invite(text, text, text, bigint)",
                    {"macadam_importer", "macadam_operator"});
}

} // namespace macadam
