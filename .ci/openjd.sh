#!/usr/bin/env bash
# Writes a wedge as an Open Job Description template, runs its tasks with the reference implementation (the PyPI package
# openjd-cli), and compares every file with what `maquette wedge` itself writes.
# Usage: bash .ci/openjd.sh MAQUETTE; needs Python 3.9 or newer, which it installs by apt where it is missing.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
maquette=$(realpath "$1")

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
if ! python3 -m venv "$out/venv" 2>/dev/null; then
    if ! command -v apt-get >/dev/null; then
        echo "python3 with venv is missing and there is no apt-get to install it with: install Python 3.9 or newer" >&2
        exit 1
    fi
    sudo=$([ "$(id -u)" = 0 ] || echo sudo)
    $sudo apt-get update -qq
    $sudo apt-get install -y -qq python3 python3-venv
    rm -rf "$out/venv"
    python3 -m venv "$out/venv"
fi
"$out/venv/bin/pip" install --quiet --disable-pip-version-check -r "$root/.ci/openjd-requirements.txt"
openjd="$out/venv/bin/openjd"

# Names that a shell would stumble over.
place="$out/it's a \$place"
mkdir "$place"
cp "$root/graphs/vest.ron" "$place"
cd "$place"

compare() {
    name=$1
    shift
    "$maquette" wedge vest.ron "$@" --openjd "$name.json" --quiet
    "$openjd" check "$name.json"
    "$openjd" run "$name.json" --step wedge -p "Maquette=$maquette" >"$name.log" || { cat "$name.log"; exit 1; }
    mv "$name" "$name by openjd"
    "$maquette" wedge vest.ron "$@" --no-record --quiet
    diff -r "$name by openjd" "$name"
    echo "$name: $(find "$name" -type f | wc -l) files are the same"
}

compare combined --vary body.k_s=0.5,2 --vary 'tilted neckline.rotate=(16,0,0),(15.5,-0.1,0)' --vary neckline.plane=top \
    --output vest -o 'combined/{body.k_s}/a "b" {tilted neckline.rotate}.glb' -o 'combined/{body.k_s}{tilted neckline.rotate}.ply'
compare zipped --vary body.k_s=0.5..2:3 --vary body.sections=20..40:3 --vary surface.rows=1,2 \
    --zip=body.k_s,body.sections --set vest.roughness=0.5 -o 'zipped/{body.sections}-{surface.rows}.obj'
compare sampled --vary body.k_s=0.1..10:log --vary body.sections=20..40 --samples 4 --seed 3 -o 'sampled/{index}.glb'
