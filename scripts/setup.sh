# scripts/setup.sh - what run.sh, test.sh and .ci/run share: packages, configuring and building.
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# To be sourced. It speaks on standard error only: standard output belongs to the program.

OBSCURA_ROOT="$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)"
OBSCURA_PACKAGES="$OBSCURA_ROOT/third_party/packages.txt"

say() { printf 'obscura: %s\n' "$*" >&2; }

stop() {
    say "$*"
    exit 1
}

# listed_packages GROUP... - the packages of these groups, one a line.
listed_packages() {
    local wanted=" $* " group='' line
    while read -r line || [[ -n "$line" ]]; do
        case "$line" in
            '' | '#'*) ;;
            '['*']') group="${line:1:-1}" ;;
            *) [[ "$wanted" == *" $group "* ]] && printf '%s\n' "$line" ;;
        esac
    done <"$OBSCURA_PACKAGES"
    return 0
}

# missing_packages GROUP... - those that dpkg does not know as installed.
missing_packages() {
    local package
    for package in $(listed_packages "$@"); do
        [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" == installed ]] ||
            printf '%s\n' "$package"
    done
}

# as_root COMMAND... - runs it with the rights that installing needs.
as_root() {
    if [[ "$(id -u)" == 0 ]]; then
        "$@"
    else
        sudo "$@"
    fi
}

# install_packages GROUP... - installs what is missing; does nothing when all is there.
install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        [[ -f "$OBSCURA_ROOT/build/.packages-noted" ]] && return 0
        say "this is not a Debian system, so nothing is installed for you. What a build needs is" \
            "listed by its Debian names in $OBSCURA_PACKAGES"
        mkdir -p "$OBSCURA_ROOT/build"
        touch "$OBSCURA_ROOT/build/.packages-noted"
        return 0
    fi
    local missing
    mapfile -t missing < <(missing_packages "$@")
    ((${#missing[@]} == 0)) && return 0
    if [[ "$(id -u)" != 0 ]] && ! command -v sudo >/dev/null; then
        stop "these packages are missing: ${missing[*]}. Installing them needs root or sudo;" \
            "ask somebody who may to run: apt-get install --no-install-recommends ${missing[*]}"
    fi
    say "installing ${missing[*]}"
    local noninteractive=(env DEBIAN_FRONTEND=noninteractive)
    as_root "${noninteractive[@]}" apt-get -q update </dev/null >&2 ||
        say "the package lists could not be brought up to date; trying with what is there"
    as_root "${noninteractive[@]}" apt-get -q -y --no-install-recommends install "${missing[@]}" \
        </dev/null >&2 || stop "apt-get could not install ${missing[*]}"
}

# build_jobs - a compiler per processor, with about 1.5 GB of memory each. OBSCURA_JOBS overrides.
build_jobs() {
    local jobs memory_kb
    jobs="$(nproc)"
    memory_kb="$(sed -n 's/^MemAvailable: *\([0-9]*\) kB$/\1/p' /proc/meminfo 2>/dev/null)"
    if [[ -n "$memory_kb" ]] && ((memory_kb / 1500000 < jobs)); then
        jobs=$((memory_kb / 1500000))
    fi
    printf '%s\n' "${OBSCURA_JOBS:-$((jobs > 1 ? jobs : 1))}"
}

# configure PRESET [OPTION...] - makes build/PRESET; what CMake says is shown only when it fails.
configure() {
    local folder="$OBSCURA_ROOT/build/$1"
    mkdir -p "$folder"
    say "configuring build/$1"
    if ! (cd "$OBSCURA_ROOT" && cmake --preset "$@") >"$folder/configure.log" 2>&1; then
        cat "$folder/configure.log" >&2
        stop "configuring failed"
    fi
}

# reconfigure PRESET NAME VALUE - sets one of CMake's options in build/PRESET, unless it is so.
reconfigure() {
    local folder="$OBSCURA_ROOT/build/$1" name="$2" value="$3"
    grep -q "^$name:[A-Z]*=$value\$" "$folder/CMakeCache.txt" && return 0
    say "configuring build/$1 with $name=$value"
    if ! cmake -D "$name=$value" "$folder" >"$folder/configure.log" 2>&1; then
        cat "$folder/configure.log" >&2
        stop "configuring failed"
    fi
}

# Options for presets that are configured for the first time.
OBSCURA_CONFIGURE=()

# build PRESET [TARGET...] - configures when needed, then builds; silent when nothing is to be done.
build() {
    local preset="$1" folder="$OBSCURA_ROOT/build/$1" targets=()
    shift
    if (($# > 0)); then targets=(--target "$@"); fi
    if [[ ! -f "$folder/build.ninja" ]]; then
        configure "$preset" "${OBSCURA_CONFIGURE[@]}"
    fi
    if ! cmake --build "$folder" -j "$(build_jobs)" "${targets[@]}" 2>&1 |
        sed -u -e '/^ninja: no work to do/d' -e '/Re-checking globbed directories/d' >&2; then
        stop "the build failed"
    fi
}
