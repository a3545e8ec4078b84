# shellcheck shell=bash
# Bare Debian 12 systems in a temporary folder, for scripts that prove something in them: source this file.
# Needs root, mmdebstrap or debootstrap, and this machine's apt set up for Debian 12. The script defines fail().

# Runs the script again in namespaces of its own: its mounts and processes are gone when it ends, and the folder can be removed
# safely. Sets $folder, which is kept if $keep is not empty.
enter_bare_folder() { # SCRIPT, its arguments
    if [[ -n ${PELLUCID_BARE_FOLDER:-} ]]; then
        folder=$PELLUCID_BARE_FOLDER
        return
    fi
    ((EUID == 0)) || fail "needs root, to make and enter the bare system"
    PELLUCID_BARE_FOLDER=$(mktemp -d "${TMPDIR:-/var/tmp}/pellucid-bare.XXXXXX")
    export PELLUCID_BARE_FOLDER
    # shellcheck disable=SC2064
    [[ -n ${keep:-} ]] || trap "rm -rf --one-file-system '$PELLUCID_BARE_FOLDER'" EXIT
    local result=0
    unshare --mount --pid --fork --kill-child "$@" || result=$?
    [[ -z ${keep:-} ]] || printf 'Kept: %s\n' "$PELLUCID_BARE_FOLDER"
    exit "$result"
}

make_bare_debian() { # ROOT
    local root=$1 mirror
    printf 'Making a bare Debian 12 in %s\n' "$root"
    # shellcheck disable=SC2016 # apt's fields, not the shell's
    apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' |
        awk '$3 ~ /^bookworm(-updates|-security)?$/' | sort -u >"$folder/sources.list"
    [[ -s $folder/sources.list ]] || fail "apt here knows no Debian 12 mirror (run apt-get update once?)"
    apt-config dump | grep -E '^Acquire::(https?::|Check-|Retries|ForceIPv)' >"$folder/apt.conf" || true

    if command -v mmdebstrap >/dev/null; then
        mmdebstrap --quiet --variant=minbase --aptopt="$folder/apt.conf" bookworm "$root" "$folder/sources.list" \
            >"$folder/bootstrap.log" 2>&1
    elif command -v debootstrap >/dev/null; then
        mirror=$(awk '$3 == "bookworm" { print $2; exit }' "$folder/sources.list")
        debootstrap --variant=minbase bookworm "$root" "$mirror" >"$folder/bootstrap.log" 2>&1 &&
            cp "$folder/sources.list" "$root/etc/apt/sources.list" &&
            cp "$folder/apt.conf" "$root/etc/apt/apt.conf.d/99host"
    else
        fail "needs mmdebstrap or debootstrap"
    fi || fail "no bare Debian could be made: $(tail -n 1 "$folder/bootstrap.log")"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    if [[ -f /etc/ssl/certs/ca-certificates.crt ]]; then # for a mirror with https
        mkdir -p "$root/etc/ssl/certs"
        cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
    fi
    mount -t proc proc "$root/proc"
}

copy_project() { # TARGET, and `worktree` for the files as they lie here instead of the last commit
    mkdir -p "$1"
    if [[ -n ${2:-} ]]; then
        git ls-files -coz --exclude-standard | { xargs -0 -r ls -d 2>/dev/null || true; } |
            tar -c --files-from=- | tar -x -C "$1"
    else
        git archive HEAD | tar -x -C "$1"
    fi
}

run_in_root() { # [-n: without network] [-u: as a user] ROOT FOLDER COMMAND...
    local -a network=() user=()
    if [[ $1 == -n ]]; then network=(unshare --net) && shift; fi
    if [[ $1 == -u ]]; then user=(--userspec=65534:65534) && shift; fi
    local root=$1 at=$2
    shift 2
    # shellcheck disable=SC2016
    env -i HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        TERM=dumb ${http_proxy+http_proxy="$http_proxy"} ${https_proxy+https_proxy="$https_proxy"} \
        "${network[@]}" chroot "${user[@]}" "$root" sh -c 'cd "$1" && shift && exec "$@"' - "$at" "$@"
}
