#!/usr/bin/env bash
# pip.sh REPOSITORY BUILD WORK PYTHON: installs the module from the source tree by pip, offline, with the libraries of BUILD,
# and imports what was installed. 77 = skipped.
set -euo pipefail
repository="$1" build="$2" work="$3" python="$4"
for module in pip setuptools wheel; do
  "$python" -c "import $module" 2>/dev/null || { echo "skipped: no $module (Debian: apt-get install python3-$module)"; exit 77; }
done
rm -rf "$work"
mkdir -p "$work"
PLUMB_BUILD_DIR="$build" "$python" -m pip install --quiet --no-index --no-build-isolation --no-deps --no-compile \
  --root-user-action ignore --target "$work/site" "$repository"
cd "$work"
PYTHONPATH="$work/site" "$python" -B -c "
import plumb, pathlib
assert pathlib.Path(plumb.__file__).parent == pathlib.Path('site').resolve(), plumb.__file__
array, log = plumb.simulate('$repository/examples/stand.toml')
assert len(plumb.calibrate(array, log).report) > 0
from importlib.metadata import version
assert version('plumb') == plumb.__version__, version('plumb')
print('installed', plumb.__version__)"
