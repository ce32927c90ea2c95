# What the scripts of this folder share; they read it with `.`, from the project's folder.

VERSION="$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1)"
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}"
# What is made is here.
PACKAGES="$CARGO_TARGET_DIR/packages"
# The one that runs on every Linux: it also prints the manual pages and completions.
PORTABLE=x86_64-unknown-linux-musl
# Files have the time of the last commit, so that equal sources make equal archives.
SOURCE_DATE_EPOCH="$(git log -1 --format=%ct)"
export SOURCE_DATE_EPOCH

# Installs Debian packages by name, those that are missing.
install_packages() {
    local package missing=()
    for package in "$@"; do
        dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    apt-get update -q >&2
    DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "${missing[@]}" >&2
}

# The command for a target, which `packaging/compile` has made.
command_of() {
    case "$1" in
    *-windows-*) echo "$CARGO_TARGET_DIR/$1/dist/staunch.exe" ;;
    *) echo "$CARGO_TARGET_DIR/$1/dist/staunch" ;;
    esac
}

# What comes with the command: how to use it, and under which terms. Manual pages and completions are made of the command line's
# own definition.
documents() {
    local folder="$1" portable shell
    portable="$(command_of "$PORTABLE")"
    mkdir -p "$folder/completions"
    cp README.md CHANGELOG.md LICENSE-APACHE LICENSE-MIT "$folder"
    packaging/third-party >"$folder/THIRD-PARTY"
    "$portable" man "$folder/man"
    for shell in bash zsh fish powershell; do
        "$portable" completions "$shell" >"$folder/completions/$(completion_of "$shell")"
    done
}

# The names that shells look for.
completion_of() {
    case "$1" in
    bash) echo staunch ;;
    zsh) echo _staunch ;;
    fish) echo staunch.fish ;;
    powershell) echo staunch.ps1 ;;
    esac
}

# The size of what was made.
made() {
    echo "$1: $(($(stat --format=%s "$1") / 1024)) KiB"
}
