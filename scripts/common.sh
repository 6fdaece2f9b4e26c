# Shared by the scripts in this folder; meant to be sourced, not run.
# It sets $root (the source tree) and offers a few small functions.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '%s\n' "$*" >&2; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# The folder that holds the Kokkos we build. It is outside the source tree so that several checkouts share it and
# `git clean` leaves it alone.
cache_dir() {
  local home=${HOME:-}
  if [ -n "${GREENWATER_CACHE:-}" ]; then
    printf '%s\n' "$GREENWATER_CACHE"
  elif [ -n "${XDG_CACHE_HOME:-}" ]; then
    printf '%s/greenwater\n' "$XDG_CACHE_HOME"
  else
    # Some service managers and containers start programs without HOME: ask the user database then.
    [ -n "$home" ] || home=$(getent passwd "$(id -u)" | cut -d: -f6) || true
    if [ -n "$home" ] && [ "$home" != / ] && [ "$home" != /nonexistent ]; then
      printf '%s/.cache/greenwater\n' "$home"
    else
      printf '/var/tmp/greenwater-%s\n' "$(id -u)"
    fi
  fi
}

# The value of one variable in the CMake cache of a build folder; empty when there is none.
cmake_cache_value() { # build-folder variable
  if [ -f "$1/CMakeCache.txt" ]; then
    sed -n "s/^$2:[A-Z]*=//p" "$1/CMakeCache.txt"
  fi
}

# A Kokkos that the user brings: prints the folder of its KokkosConfig.cmake and returns 0, or returns 1.
# The order is CMake's own, so that set-up and configure always speak of the same one.
user_kokkos() {
  local prefix dir paths
  for prefix in "${Kokkos_ROOT:-}" "${Kokkos_DIR:-}"; do
    [ -n "$prefix" ] || continue
    for dir in "$prefix" "$prefix"/lib/cmake/Kokkos "$prefix"/lib64/cmake/Kokkos "$prefix"/lib/*/cmake/Kokkos; do
      if [ -f "$dir/KokkosConfig.cmake" ]; then printf '%s\n' "$dir" && return 0; fi
    done
  done
  IFS=':;' read -r -a paths <<<"${CMAKE_PREFIX_PATH:-}"
  for prefix in ${paths[@]+"${paths[@]}"}; do
    [ -n "$prefix" ] || continue
    for dir in "$prefix"/lib/cmake/Kokkos "$prefix"/lib64/cmake/Kokkos "$prefix"/lib/*/cmake/Kokkos; do
      if [ -f "$dir/KokkosConfig.cmake" ]; then printf '%s\n' "$dir" && return 0; fi
    done
  done
  # Chosen earlier with cmake -DKokkos_DIR=... or the like: the build folder remembers it, but it remembers one that
  # set-up built just as well. Those carry a file by which they are known.
  dir=$(cmake_cache_value "$root/build/openmp" Kokkos_DIR)
  if [ -n "$dir" ] && [ -f "$dir/KokkosConfig.cmake" ] && [ ! -f "$dir/../../../built-by-greenwater" ]; then
    printf '%s\n' "$dir" && return 0
  fi
  return 1
}

# OpenMP threads that wait for work must sleep, not spin: on a machine whose cores are shared with other programs a
# spinning thread takes the core from the very thread it is waiting for, and a run becomes many times slower.
# For the same reason threads are not tied to cores. A value that the user has set stays.
quiet_openmp() {
  export OMP_WAIT_POLICY="${OMP_WAIT_POLICY:-passive}"
  export OMP_PROC_BIND="${OMP_PROC_BIND:-false}"
}

# Runs a command with its output kept in a log, which is shown only when the command fails. If it takes longer than two
# seconds, a line says what is going on.
quietly() { # what log command...
  local what=$1 log=$2 notice status=0
  shift 2
  mkdir -p "$(dirname "$log")"
  # The sleep gets no output of ours: it may outlive us by a moment, and whoever reads our output would wait for it.
  (sleep 2 >/dev/null 2>&1 && say "$what ... (log: $log)") >/dev/null &
  notice=$!
  "$@" >"$log" 2>&1 || status=$?
  kill "$notice" 2>/dev/null || true
  wait "$notice" 2>/dev/null || true
  if [ "$status" -ne 0 ]; then
    cat "$log" >&2
    say "$what failed; the output above is also in $log"
  fi
  return "$status"
}

# Sets up what is missing, configures the preset if that has not happened yet, and builds.
build_preset() { # preset cmake-build-arguments...
  local preset=$1 march
  shift
  march=${GREENWATER_MARCH:-$(cmake_cache_value "$root/build/$preset" GREENWATER_MARCH)}
  march=${march:-native}
  "$root/scripts/setup" --if-needed --march "$march" || return 1
  cd "$root"
  if [ ! -f "build/$preset/build.ninja" ] || [ "$(cmake_cache_value "build/$preset" GREENWATER_MARCH)" != "$march" ]; then
    quietly "Configuring build/$preset" "$root/build/$preset/configure.log" \
      cmake --preset "$preset" "-DGREENWATER_MARCH=$march" || return 1
  fi
  quietly "Building build/$preset" "$root/build/$preset/build.log" \
    cmake --build "build/$preset" "$@" || return 1
  cd - >/dev/null
}
