#!/bin/sh
# Builds the page: dashboard/page/src to dashboard/page/dist. With --check: builds it elsewhere and compares with what is committed.
set -eu
cd "$(dirname "$0")"
[ -d node_modules ] || npm ci --no-audit --no-fund --ignore-scripts
if [ "${1:-}" = --check ]; then
    other=$(mktemp -d)
    trap 'rm -rf "$other"' EXIT
    node build.mjs "$other"
    diff -rq dist "$other" || {
        echo "dashboard/page/dist is not what its sources give: run dashboard/page/build.sh and commit dist" >&2
        exit 1
    }
    # A lock file that names a registry sends whoever installs to it.
    if grep '"resolved"' package-lock.json; then
        echo "dashboard/page/package-lock.json names a registry (lines above): make it with npm install --omit-lockfile-registry-resolved" >&2
        exit 1
    fi
else
    node build.mjs
fi
size=$(cat dist/app.js dist/app.css dist/index.html dist/LICENSES.txt | gzip -9 | wc -c)
echo "page: $size bytes with gzip of at most 250000"
[ "$size" -le 250000 ]
