# Sourced by the other scripts: makes .venv and installs Diorama into it once.
# Needs nothing but python3 (3.11 or later) with venv.

cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '%s\n' "$*" >&2; }

# Runs a command as root when we may, without ever asking for a password.
as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"
    elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then sudo -n "$@"
    else return 126
    fi
}

apt_updated=
install_system() {
    if ! command -v apt-get >/dev/null; then
        say "Missing system packages: $*. Install them with your system's package manager, then run this again."
        return 1
    fi
    if [ -z "$apt_updated" ]; then
        as_root apt-get update -qq >/dev/null 2>&1
        apt_updated=yes
    fi
    if ! DEBIAN_FRONTEND=noninteractive as_root apt-get install -y -qq --no-install-recommends \
        -o DPkg::Lock::Timeout=300 "$@" >/dev/null 2>&1; then
        say "Missing system packages. Run: sudo apt-get install -y $*"
        return 1
    fi
}

find_python() {
    for candidate in python3.11 python3.12 python3.13 python3; do
        if command -v "$candidate" >/dev/null &&
            "$candidate" -c 'import sys; raise SystemExit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' 2>/dev/null; then
            printf '%s' "$candidate"
            return
        fi
    done
    say "Diorama needs Python 3.11, 3.12 or 3.13. Run: sudo apt-get install -y python3 python3-venv"
    return 1
}

# install EXTRAS ("" or "dev,sim") [PIP OPTIONS]: into .venv, once for each state of pyproject.toml and constraints.txt.
install() {
    local extras="$1" python stamp
    shift
    if [ ! -x .venv/bin/python ]; then
        python="$(find_python)" || exit 1
        if ! "$python" -m venv .venv >/dev/null 2>&1; then
            rm -rf .venv
            install_system python3-venv || exit 1
            "$python" -m venv .venv || { say "Could not create .venv with $python -m venv"; exit 1; }
        fi
    fi
    stamp=".venv/.installed-${extras:-core}-$(cat pyproject.toml constraints.txt | cksum | tr ' ' '-')"
    if [ ! -e "$stamp" ]; then
        say "Installing Diorama into .venv (once; a few minutes)…"
        # The pip that comes with Python 3.11 reads the lists of files of all packages three times as slowly as today's.
        .venv/bin/python -m pip install --quiet --disable-pip-version-check --upgrade pip || say "pip stays as it is."
        PYTHONWARNINGS=ignore .venv/bin/python -m pip install --quiet --disable-pip-version-check \
            --constraint constraints.txt "$@" --editable ".${extras:+[$extras]}" ||
            { say "The installation failed; the lines above say why."; exit 1; }
        rm -f .venv/.installed-"${extras:-core}"-*
        touch "$stamp"
    fi
    if [ ! -e .venv/.system-ok ]; then
        if ! .venv/bin/python -c 'import open3d' >/dev/null 2>&1; then
            install_system libusb-1.0-0 libgl1 libegl1 libgomp1 libx11-6 || exit 1
            .venv/bin/python -c 'import open3d' || { say "open3d does not load; the lines above name the missing library."; exit 1; }
        fi
        touch .venv/.system-ok
    fi
}
