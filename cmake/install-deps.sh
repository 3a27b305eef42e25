#!/usr/bin/env bash
# Installs what libbrainshift needs, on Debian and Ubuntu; elsewhere says what is missing.
set -euo pipefail

usage() {
  cat <<'END'
Usage: cmake/install-deps.sh [GROUP]...

Groups (default: core):
  core   compiler, CMake, Ninja, Eigen, SuiteSparse, METIS, a serial OpenBLAS, and the libraries of
         the io target and the examples
  test   GoogleTest; Python with numpy and VTK for checks against VTK; where it can be had,
         Siconos for a cross-check of complementarity problems, CalculiX for one of a solve, abidiff for
         the ABI of the C face,
         Doxygen and Sphinx for the reference and the site, and what draws pictures and reports, with Chromium to look at them
  data   what examples/head needs to make the head anew: volumes, CGAL, Python packages
  own_head  what examples/own_head needs: CGAL, Python packages (nibabel, VTK)
  python what python/brainshift.py needs: numpy
  fuzz   clang with libFuzzer and clang-tidy, for tests/robustness
  docs   what draws pictures, charts and reports: VTK, matplotlib, a virtual X server
  site   what makes the site of documents: Sphinx with MyST, Doxygen
  bench  Google Benchmark
  peers  CalculiX, for comparison
  threaded_blas  OpenBLAS with threads, unpacked in out/threaded_blas for tests/robustness/blas: installed,
         Debian would prefer it to the serial one everywhere

Does nothing where all is installed. Needs root or sudo only if something is missing.
END
}

# One line per package: Debian's name | probe on other systems | what it is.
# Probes: "command:NAME", "header:FILE", "python:MODULE", "-" for none.
packages_of() {
  case "$1" in
    core) cat <<'END'
build-essential|command:c++|a C++17 compiler
cmake|command:cmake|CMake 3.22 or newer
ninja-build|command:ninja|Ninja
pkg-config|command:pkg-config|pkg-config
libeigen3-dev|header:Eigen/Core|Eigen 3.3 or newer
libsuitesparse-dev|header:cholmod.h|SuiteSparse (CHOLMOD)
libmetis-dev|header:metis.h|METIS 5
libopenblas0-serial|-|OpenBLAS, built without threads
libpugixml-dev|header:pugixml.hpp|pugixml
zlib1g-dev|header:zlib.h|zlib
nlohmann-json3-dev|header:nlohmann/json.hpp|nlohmann-json
libcli11-dev|header:CLI/CLI.hpp|CLI11
END
      ;;
    test) cat <<'END'
libgtest-dev|header:gtest/gtest.h|GoogleTest
python3-numpy|python:numpy|numpy
python3-vtk9|python:vtk|VTK 9 for Python
END
      ;;
    data) cat <<'END'
mricron-data|-|MRIcron's templates (Colin27: ch2, ch2bet, ch2better)
libcgal-dev|header:CGAL/version.h|CGAL 5
libboost-dev|header:boost/version.hpp|Boost
libeigen3-dev|header:Eigen/Core|Eigen 3.3 or newer
cmake|command:cmake|CMake 3.22 or newer
g++|command:c++|a C++17 compiler
python3-nibabel|python:nibabel|nibabel
python3-numpy|python:numpy|numpy
python3-scipy|python:scipy|scipy
python3-skimage|python:skimage|scikit-image
python3-matplotlib|python:matplotlib|matplotlib
python3-vtk9|python:vtk|VTK 9 for Python
END
      ;;
    own_head) cat <<'END'
libcgal-dev|header:CGAL/version.h|CGAL 5
libboost-dev|header:boost/version.hpp|Boost
python3-nibabel|python:nibabel|nibabel
python3-numpy|python:numpy|numpy
python3-scipy|python:scipy|scipy
python3-skimage|python:skimage|scikit-image
python3-vtk9|python:vtk|VTK 9 for Python
END
      ;;
    python) cat <<'END'
python3-numpy|python:numpy|numpy
END
      ;;
    fuzz) cat <<'END'
clang|command:clang++|clang
libclang-rt-dev|-|clang's sanitizers and libFuzzer
clang-tidy|command:clang-tidy|clang-tidy
END
      ;;
    docs) cat <<'END'
python3-numpy|python:numpy|numpy
python3-vtk9|python:vtk|VTK 9 for Python
python3-matplotlib|python:matplotlib|matplotlib
python3-pil|python:PIL|Pillow
xvfb|command:xvfb-run|a virtual X server (Xvfb)
xauth|command:xauth|xauth
libgl1-mesa-dri|-|a software OpenGL
END
      ;;
    site) cat <<'END'
python3-sphinx|python:sphinx|Sphinx
python3-myst-parser|python:myst_parser|MyST
python3-sphinx-rtd-theme|python:sphinx_rtd_theme|Sphinx's theme of Read the Docs
doxygen|command:doxygen|Doxygen
END
      ;;
    bench) cat <<'END'
libbenchmark-dev|header:benchmark/benchmark.h|Google Benchmark
END
      ;;
    peers) cat <<'END'
calculix-ccx|command:ccx|CalculiX
END
      ;;
  esac
}

# The same for what a group can do without: tests that need it are skipped, and say so.
optional_of() {
  case "$1" in
    test) cat <<'END'
libsiconos-numerics-dev|header:siconos/SiconosConfig.h|Siconos
abigail-tools|command:abidiff|abidiff
doxygen|command:doxygen|Doxygen
python3-sphinx|python:sphinx|Sphinx
python3-myst-parser|python:myst_parser|MyST
python3-sphinx-rtd-theme|python:sphinx_rtd_theme|Sphinx's theme of Read the Docs
python3-matplotlib|python:matplotlib|matplotlib
python3-pil|python:PIL|Pillow
xvfb|command:xvfb-run|Xvfb
xauth|command:xauth|xauth
libgl1-mesa-dri|command:xvfb-run|Mesa
calculix-ccx|command:ccx|CalculiX
chromium|command:chromium|Chromium
END
      ;;
  esac
}

has_header() {
  local compiler=${CXX:-c++} root paths=()
  for root in /usr /usr/local /opt/local /opt/homebrew ${CMAKE_PREFIX_PATH//[:;]/ }; do
    paths+=("-I$root/include/eigen3" "-I$root/include/suitesparse" "-I$root/include")
  done
  echo "#include <$1>" | "$compiler" -std=c++17 -x c++ -E "${paths[@]}" - >/dev/null 2>&1
}

is_there() {
  case "$1" in
    command:*) command -v "${1#command:}" >/dev/null ;;
    header:*) has_header "${1#header:}" ;;
    python:*) python3 -c "import ${1#python:}" >/dev/null 2>&1 ;;
    *) true ;;
  esac
}

on_debian() { command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; }

# Prints "package|what it is" for each one missing.
missing_of() {
  local group package probe what
  for group in "$@"; do
    while IFS='|' read -r package probe what; do
      if on_debian; then
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
          echo "$package|$what"
      else
        is_there "$probe" || echo "$package|$what"
      fi
    done < <(packages_of "$group")
  done | sort -u
}

apt() { ${SUDO:-} env DEBIAN_FRONTEND=noninteractive apt-get -q -y "$@"; }

apt_knows() {
  local package
  for package in "$@"; do apt-cache show "$package" >/dev/null 2>&1 || return 1; done
}

apt_install() {
  SUDO=
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "install-deps: run this as root:  apt-get install $*" >&2
      exit 1
    fi
    SUDO=sudo
  fi
  # The lists of a fresh machine are empty, those of an old one may name files that are gone.
  if ! apt_knows "$@"; then
    apt update
  elif apt install --no-install-recommends "$@"; then
    return
  else
    apt update
  fi
  apt install --no-install-recommends "$@"
}

may_install() { [ "$(id -u)" -eq 0 ] || sudo -n true 2>/dev/null; }

# Never asks for a password, never fails. Siconos' BLAS is any OpenBLAS: the serial one is named
# along with it, or apt would add a threaded one.
install_optional() {
  local group line lines package probe what
  for group in "$@"; do
    mapfile -t lines < <(optional_of "$group")
    for line in ${lines[@]+"${lines[@]}"}; do
      IFS='|' read -r package probe what <<<"$line"
      if on_debian; then
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ] || continue
        if apt_knows "$package" && may_install; then
          echo "install-deps: installing $package (optional)"
          if apt_install libopenblas0-serial "$package"; then continue; fi
        fi
      elif is_there "$probe"; then
        continue
      fi
      echo "install-deps: $what ($package) is not there; tests that need it are skipped" >&2
    done
  done
}

# CHOLMOD calls whatever libblas.so.3 is. The library threads over bodies and elements itself, and
# its results are bit-identical only with a BLAS that does not: Debian's alternatives prefer
# OpenBLAS to the reference BLAS, but a threaded OpenBLAS to the serial one.
report_blas() {
  local arch link blas
  arch=$(dpkg-query -W -f='${Architecture}' libopenblas0-serial 2>/dev/null) || return 0
  arch=$(dpkg-architecture -a"$arch" -qDEB_HOST_MULTIARCH 2>/dev/null) || return 0
  link=libblas.so.3-$arch
  blas=$(readlink -f "/usr/lib/$arch/libblas.so.3" || true)
  case "$blas" in
    */openblas-serial/*) echo "install-deps: the BLAS in use is the serial OpenBLAS ($blas)" ;;
    *)
      echo "install-deps: the BLAS in use is ${blas:-unknown}, not the serial OpenBLAS; results may be" >&2
      echo "  slower and differ in the last bits from run to run. To choose it for this machine:" >&2
      echo "  update-alternatives --set $link /usr/lib/$arch/openblas-serial/libblas.so.3" >&2
      ;;
  esac
}

unpack_threaded_blas() {
  local package=libopenblas0-pthread folder
  folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/out/threaded_blas
  if [ -d "$folder/usr" ]; then return; fi
  if ! on_debian; then
    echo "install-deps: not Debian or Ubuntu; tests of an OpenBLAS with threads are skipped" >&2
    return
  fi
  mkdir -p "$folder"
  if ! (cd "$folder" && apt-get -q download "$package" && dpkg-deb -x "$package"_*.deb . && rm "$package"_*.deb); then
    echo "install-deps: $package cannot be had; tests of an OpenBLAS with threads are skipped" >&2
  fi
}

main() {
  local group lines names package what
  for group in "$@"; do
    case "$group" in
      -h | --help) usage; exit 0 ;;
      core | test | data | own_head | python | fuzz | docs | site | bench | peers | threaded_blas) ;;
      *) echo "install-deps: unknown group '$group'; known: core test data own_head python fuzz docs site bench peers threaded_blas" >&2; exit 2 ;;
    esac
  done
  [ $# -gt 0 ] || set -- core

  lines=$(missing_of "$@")
  if [ -n "$lines" ] && ! on_debian; then
    echo "install-deps: not Debian or Ubuntu; please install:" >&2
    while IFS='|' read -r package what; do
      echo "  $what (Debian: $package)" >&2
    done <<<"$lines"
    exit 1
  fi
  if [ -n "$lines" ]; then
    names=$(echo "$lines" | cut -d'|' -f1 | tr '\n' ' ')
    echo "install-deps: installing $names"
    # shellcheck disable=SC2086  # one word per package
    apt_install $names
  else
    echo "install-deps: $*: all installed"
  fi
  install_optional "$@"
  case " $* " in *" threaded_blas "*) unpack_threaded_blas ;; esac
  case " $* " in *" core "*) if on_debian; then report_blas; fi ;; esac
}

main "$@"
