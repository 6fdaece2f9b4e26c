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

# Makes the cache and keeps everybody else from adding to it; sets $cache. Two set-ups at once must not build the same
# thing twice; the second waits and finds it done.
lock_cache() {
  cache=$(cache_dir)
  mkdir -p "$cache" || die "cannot make $cache; choose another folder with GREENWATER_CACHE."
  # In the fall-back place below /var/tmp anybody could have made the folder; never use another user's.
  case $cache in
    /var/tmp/*) [ -O "$cache" ] || die "$cache belongs to another user; choose a folder with GREENWATER_CACHE." ;;
  esac
  exec 9>"$cache/.lock"
  flock 9
}

# Sets $work to an empty folder in the locked cache, which disappears with us, or with end_work.
begin_work() {
  # Left over from a set-up that was killed; we hold the lock, so nobody works in it.
  rm -rf "$cache"/.build.*
  work=$cache/.build.$$
  mkdir "$work"
  trap 'rm -rf "$work"' EXIT
  trap 'exit 130' INT TERM HUP
}

# Removes $work and gives the cache back.
end_work() {
  rm -rf "$work"
  trap - EXIT INT TERM HUP
  exec 9>&-
}

# The mirrors this machine takes Debian from, best first: repositories that call themselves Debian, then those whose
# index has not been fetched yet and that therefore have no label.
debian_mirrors() {
  if [ -n "${GREENWATER_DEBIAN_MIRROR:-}" ]; then
    printf '%s\n' "$GREENWATER_DEBIAN_MIRROR"
    return
  fi
  apt-get indextargets --format '$(LABEL)|$(RELEASE)|$(COMPONENT)|$(REPO_URI)' 2>/dev/null |
    awk -F'|' '$3 == "main" && $2 !~ /-/ && $1 == "Debian" { print 1, $4 }
               $3 == "main" && $2 !~ /-/ && $1 !~ /^Debian/ { print 2, $4 }' | sort -u | cut -d' ' -f2- | awk '!seen[$0]++'
}

# Fetches from a suite of Debian with apt, which checks against Debian's signature, into the folder's download/. Only our
# own index folder and source list are used: the machine's /etc/apt is read (proxy, credentials, keys) but nothing of
# apt's state is touched. Shows apt's words when it fails.
fetch_from_debian() { # folder deb|deb-src suite apt-get-arguments...
  local dir=$1 kind=$2 suite=$3 mirror keyring signed=
  shift 3
  mkdir -p "$dir/lists/partial" "$dir/cache/archives/partial" "$dir/download"
  for keyring in /usr/share/keyrings/debian-archive-keyring.{gpg,pgp}; do
    if [ -f "$keyring" ]; then signed="[signed-by=$keyring] " && break; fi
  done
  cat >"$dir/apt.conf" <<END
Dir::Etc::SourceList "$dir/sources.list";
Dir::Etc::SourceParts "-";
Dir::State::Lists "$dir/lists";
Dir::Cache "$dir/cache";
// The machine's own apt may have hooks that clean up or announce after an update; this is not one of its updates.
#clear APT::Update::Pre-Invoke;
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
// As root apt would download as user _apt, who cannot write into our folder.
APT::Sandbox::User "root";
APT::Get::List-Cleanup "false";
Acquire::Languages "none";
Acquire::Retries "3";
Acquire::http::Timeout "60";
END
  : >"$dir/log"
  while read -r mirror; do
    printf '%s %s%s %s main\n' "$kind" "$signed" "$mirror" "$suite" >"$dir/sources.list"
    if apt-get -c "$dir/apt.conf" update -qq --error-on=any >>"$dir/log" 2>&1 </dev/null &&
      (cd "$dir/download" && apt-get -c "$dir/apt.conf" "$@") >>"$dir/log" 2>&1 </dev/null; then
      return 0
    fi
  done < <(debian_mirrors)
  cat "$dir/log" >&2
  return 1
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
