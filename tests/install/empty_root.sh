#!/bin/sh
# Run by package_test.sh inside an empty root: installs the packages there and uses them, first with their dependencies alone,
# then with the program's recommendations and a compiler.
set -eu
cd /tmp
export DEBIAN_FRONTEND=noninteractive

install="apt-get install --yes --quiet --no-install-recommends"
$install ./tribound.deb
sh use_installation.sh program /usr /tmp/used
$install ./python3-tribound.deb
sh use_installation.sh module /usr /tmp/used

# shellcheck disable=SC2046,SC2016
$install $(dpkg-query --show --showformat '${Recommends}' tribound | tr , ' ') g++ cmake make
sh use_installation.sh library /usr /tmp/used
mpirun --allow-run-as-root --oversubscribe -n 2 \
  tribound run /usr/share/doc/tribound/examples/01_tresca_block/case.toml --set 'output.directory="/tmp/used/two"'
mpirun --allow-run-as-root --oversubscribe -n 2 python3 -B -c "
import tribound as tb
result = tb.run(tb.Case.read('/usr/share/doc/tribound/examples/01_tresca_block/case.toml'))
assert result.certificate['program']['processes'] == 2"
apt-get remove --yes --quiet python3-tribound
if [ -e /usr/lib/python3/dist-packages/tribound ]; then
  echo "empty_root: python3-tribound leaves files behind" >&2
  exit 1
fi
