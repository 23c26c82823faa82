#!/usr/bin/env bash
# swift.sh FOLDER PORT: OpenStack Swift with its S3 API (packages of Debian) on 127.0.0.1, ports PORT
# to PORT + 3, until standard input ends. The key is test:tester, its secret testing.
set -euo pipefail
folder=$1 port=$2
mkdir -p "$folder"/{etc,node/d1}
cd "$folder/etc"
cat >swift.conf <<'TEXT'
[swift-hash]
swift_hash_path_prefix = a
swift_hash_path_suffix = b
TEXT
common="bind_ip = 127.0.0.1
workers = 0
user = $(id -un)
swift_dir = $folder/etc"
number=0
for kind in account container object; do
    number=$((number + 1))
    cat >$kind.conf <<TEXT
[DEFAULT]
$common
bind_port = $((port + number))
devices = $folder/node
mount_check = false
[pipeline:main]
pipeline = $kind-server
[app:$kind-server]
use = egg:swift#$kind
TEXT
    swift-ring-builder $kind.builder create 1 1 1
    swift-ring-builder $kind.builder add "r1z1-127.0.0.1:$((port + number))/d1" 1
    swift-ring-builder $kind.builder rebalance
done >/dev/null
cat >proxy.conf <<TEXT
[DEFAULT]
$common
bind_port = $port
[pipeline:main]
pipeline = catch_errors cache s3api tempauth proxy-server
[app:proxy-server]
use = egg:swift#proxy
account_autocreate = true
[filter:catch_errors]
use = egg:swift#catch_errors
[filter:cache]
use = egg:swift#memcache
memcache_servers = 127.0.0.1:1
[filter:s3api]
use = egg:swift#s3api
location = us-east-1
[filter:tempauth]
use = egg:swift#tempauth
user_test_tester = testing .admin
TEXT
servers=()
trap 'kill "${servers[@]}"' EXIT
for kind in account container object proxy; do
    swift-$kind-server $kind.conf >"$folder/$kind.log" 2>&1 </dev/null &
    servers+=($!)
done
cat >/dev/null
