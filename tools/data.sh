#!/usr/bin/env bash
# Brings the public measured data that the measured tests and the figures read; --help teaches.
#   tools/data.sh [--from DIR] [--to DIR] [--mirror BASE] [--list] [--check [DIR]] [SET...]
# What it brings stands in tools/data/table.toml; the work is done by tools/data/kit.py.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# Debian's own Python finds Debian's numpy and scipy.
python=/usr/bin/python3
[ -x "$python" ] || python=python3
command -v "$python" >/dev/null || { echo "data: needs python3 3.11 or newer (tools/setup.sh --data installs it)" >&2; exit 1; }
PYTHONDONTWRITEBYTECODE=1 exec "$python" "$here/data/kit.py" "$@"
