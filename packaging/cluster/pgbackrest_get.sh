#!/bin/sh
# Fetches a file of WAL with pgBackRest, stanza macadam: restore_command of a cluster's servers (docs/cluster.md).
#
#     restore_command: '/usr/local/bin/macadam-pgbackrest-get %f %p'
#
# A primary that crashed may have written more than its successor got. It must recover on its own timeline: with the history
# of the successor's, PostgreSQL takes what it wrote beyond the fork for that of the new timeline, Patroni does not see that it
# is to be rewound, and it never catches up. So it gets no history before it has recovered; the successor sends it later.
case $1 in
*.history)
    state=$("/usr/lib/postgresql/$(cat PG_VERSION)/bin/pg_controldata" . | sed -n 's/^Database cluster state: *//p')
    [ "$state" != 'in production' ] || exit 1
    ;;
esac
exec pgbackrest --stanza=macadam archive-get "$1" "$2"
