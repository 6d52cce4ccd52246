#!/usr/bin/env bash
# Makes the package, inspects it, and uses it in an empty root with Debian packages from the same archive as those of this
# machine. Needs the network, and root rights or user namespaces.
#   package_test.sh SOURCE
set -euo pipefail
source=$1
here=$source/tests/install
"$source/scripts/package"
package=$(ls "$source"/build/package/*.deb)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# One package has program, library and headers (docs/decisions.md), and CPack calls ldconfig itself.
not_meant=package-name-doesnt-match-sonames,link-to-shared-library-in-wrong-package,lacks-ldconfig-trigger,maintscript-calls-ldconfig
lintian --fail-on error,warning --suppress-tags "$not_meant" "$package"

dpkg-deb --extract "$package" "$scratch/files"
if grep -rlF "$source" "$scratch/files"; then
  echo "package_test: these files name the source tree" >&2
  exit 1
fi

cp "$package" "$scratch/tribound.deb"
# shellcheck disable=SC2016
apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' \
  'Created-By: Packages' 'Origin: Debian' | sort -u |
  mmdebstrap --variant=apt \
    --customize-hook="copy-in $scratch/tribound.deb $here/use_installation.sh $here/empty_root.sh /tmp" \
    --customize-hook='chroot "$1" sh /tmp/empty_root.sh' \
    "$(. /etc/os-release && echo "$VERSION_CODENAME")" /dev/null -
