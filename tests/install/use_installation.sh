#!/bin/sh
# Uses an installation as its users do, outside the sources.
#   use_installation.sh program PREFIX SCRATCH                  runs the first of its examples, examines a case with a geometry
#   use_installation.sh library PREFIX SCRATCH [CMAKE_ARGUMENT...]      builds its C++ examples and runs them
#   use_installation.sh module PREFIX SCRATCH [PYTHON]                  runs cases from Python
set -eu
what=$1 prefix=$2 scratch=$3
shift 3
share=$prefix/share
export PATH="$prefix/bin:$PATH"

fail()
{
  echo "use_installation: $*" >&2
  exit 1
}

use_program()
{
  [ -e "$share/man/man1/tribound.1" ] || [ -e "$share/man/man1/tribound.1.gz" ] || fail "the manual is not installed"
  for file in bash-completion/completions/tribound zsh/site-functions/_tribound tribound/picture \
    tribound/study_figures tribound/tribound.schema.json doc/tribound/docs/case-format.md doc/tribound/docs/images/report.png doc/tribound/docs/gallery.md \
    doc/tribound/docs/images/12_flange.png doc/tribound/examples/05_dam/case.toml; do
    [ -e "$share/$file" ] || fail "$share/$file is not installed"
  done
  tribound --help | grep -qxF "  $share/doc/tribound/docs" || fail "--help does not say where the guide is: $(tribound --help)"

  tribound run "$share/doc/tribound/examples/01_tresca_block/case.toml" --set "output.directory=\"$scratch/block\""
  [ -e "$scratch/block/certificate.json" ] || fail "the run has left no certificate"
  if [ -e "$share/tribound/report.html" ]; then
    tribound info | grep -qF " $share/tribound/report.html" || fail "info does not find the report page: $(tribound info)"
    [ -e "$scratch/block/report.html" ] || fail "the run has left no report page"
  fi

  tribound init dam --directory "$scratch/dam"
  tribound check "$scratch/dam/dam.toml" # meshed by Gmsh
}

use_library()
{
  cmake -S "$share/doc/tribound/examples/cpp" -B "$scratch/build" -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH="$prefix" "$@"
  cmake --build "$scratch/build"
  for program in certified_block own_loop load_path; do "$scratch/build/$program"; done
}

use_module()
{
  python=${1:-/usr/bin/python3}
  packages=$prefix/lib/python3/dist-packages
  [ "$prefix" = /usr ] || export PYTHONPATH="$packages"
  for file in py.typed _tribound.pyi; do
    [ -e "$packages/tribound/$file" ] || fail "$packages/tribound/$file is not installed"
  done
  cd "$scratch"
  # Results without a directory vanish with the result: what the run has left is looked at before.
  "$python" -B -c "
import tribound as tb
assert tb.__file__ == '$packages/tribound/__init__.py', tb.__file__
result = tb.run(tb.Case.read('$share/doc/tribound/examples/01_tresca_block/case.toml'))
assert result.is_certified, result.reason
import os
page = '$share/tribound/report.html'
assert (result.directory / 'report.html').exists() or not os.path.exists(page), 'the run has left no report page'
"
  "$python" -B "$share/doc/tribound/examples/python/own_load.py"
}

mkdir -p "$scratch"
"use_$what" "$@"
