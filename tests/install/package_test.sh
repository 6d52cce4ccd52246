#!/usr/bin/env bash
# Makes the packages, inspects them, and uses them in an empty root with Debian packages from the same archive as those of this
# machine. Needs the network, and root rights or user namespaces.
#   package_test.sh SOURCE
set -euo pipefail
source=$1
here=$source/tests/install
"$source/scripts/package"
packages=("$source"/build/package/{,python3-}tribound_*.deb)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# The first package has program, library and headers (docs/decisions.md), and CPack calls ldconfig itself.
not_meant=package-name-doesnt-match-sonames,link-to-shared-library-in-wrong-package,lacks-ldconfig-trigger,maintscript-calls-ldconfig
lintian --fail-on error,warning --suppress-tags "$not_meant" "${packages[@]}"

for package in "${packages[@]}"; do
  dpkg-deb --extract "$package" "$scratch/files"
  name=$(basename "$package")
  cp "$package" "$scratch/${name%%_*}.deb"
done
if grep -rlF "$source" "$scratch/files"; then
  echo "package_test: these files name the source tree" >&2
  exit 1
fi

# shellcheck disable=SC2016
apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' \
  'Created-By: Packages' 'Origin: Debian' | sort -u |
  mmdebstrap --variant=apt \
    --customize-hook="copy-in $scratch/tribound.deb $scratch/python3-tribound.deb $here/use_installation.sh $here/empty_root.sh /tmp" \
    --customize-hook='chroot "$1" sh /tmp/empty_root.sh' \
    "$(. /etc/os-release && echo "$VERSION_CODENAME")" /dev/null -
