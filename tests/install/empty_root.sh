#!/bin/sh
# Run by package_test.sh inside an empty root: installs the package there and uses it, first with its dependencies alone,
# then with its recommendations and a compiler.
set -eu
cd /tmp
export DEBIAN_FRONTEND=noninteractive

install="apt-get install --yes --quiet --no-install-recommends"
$install ./tribound.deb
sh use_installation.sh program /usr /tmp/used

# shellcheck disable=SC2046,SC2016
$install $(dpkg-query --show --showformat '${Recommends}' tribound | tr , ' ') g++ cmake make
sh use_installation.sh library /usr /tmp/used
mpirun --allow-run-as-root --oversubscribe -n 2 \
  tribound run /usr/share/doc/tribound/examples/01_tresca_block/case.toml --set 'output.directory="/tmp/used/two"'
