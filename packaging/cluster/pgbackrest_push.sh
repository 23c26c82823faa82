#!/bin/sh
# Archives a file of WAL with pgBackRest, stanza macadam: archive_command of a cluster's servers (docs/cluster.md).
#
#     archive_command: '/usr/local/bin/macadam-pgbackrest-push %p'   # pgBackRest insists on its name in it
#
# After a failure a server may hold a segment of a timeline that has ended, while the archive has it of another server, with
# another end. pgBackRest refuses such a one (exit 45), PostgreSQL repeats it for ever and archives nothing behind it. If the
# present timeline was forked off in that segment or before it, no recovery reads it: it is left out. Otherwise two servers
# wrote one timeline, and the refusal stands.
pgbackrest --stanza=macadam archive-push "$1"
status=$?
[ "$status" -eq 45 ] || exit "$status"

name=${1##*/}
name=${name%.partial}
[ "${#name}" -eq 24 ] || exit 45
case $name in *[!0-9A-F]*) exit 45 ;; esac
timeline=$((0x${name%????????????????}))
log_and_segment=${name#????????}
bytes=$(stat -c %s "$1")
end=$((0x${log_and_segment%????????} * 4294967296 + (0x${log_and_segment#????????} + 1) * bytes))

history=$(ls "${1%/*}"/*.history 2>/dev/null | tail -n 1) # of the present timeline
present=${history##*/}
[ "$timeline" -lt $((0x0${present%.history})) ] || exit 45
while read -r ended fork _; do
    [ "$ended" = "$timeline" ] || continue
    [ "$end" -gt $((0x${fork%/*} * 4294967296 + 0x${fork#*/})) ] || exit 45
done <"$history"
echo "pgbackrest_push: $name, archived with another end, lies beyond the end of its timeline by ${history##*/}: left out" >&2
