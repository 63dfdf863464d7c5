#!/usr/bin/env bash
# Draws the pictures of the README from the saved graphs.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --release
maquette="${CARGO_TARGET_DIR:-target}/release/maquette"
mkdir -p docs/pictures
draw() { "$maquette" render "graphs/$1.ron" -o "docs/pictures/$2.png" --size "$3" --quiet "${@:4}"; }
draw warrior warrior 560x800
draw warrior warrior-body 480x800 --output skin --output lips --output eyeballs --output irises --output pupils --output teeth
draw vest vest-curves 560x640 --curves
draw vest vest 560x640
draw vest vest-wireframe 560x640 --wireframe
draw head head 480x640
draw head head-curves 480x640 --curves --view side
draw neck neck 560x480 --curves
draw leg leg 400x640 --curves
draw legs legs 560x640 --curves
draw human human 480x720
draw human human-side 480x720 --view side
draw leg-deformed leg-deformed 320x560
draw leg-free-form leg-free-form 320x560 --curves
draw sea-star sea-star 480x440
draw blend blend 320x560 --wireframe
draw shoulder shoulder 560x480
draw patch patch 560x400 --curves
draw chest chest 400x560 --curves
draw forearm forearm 400x480 --wireframe
draw hip hip 480x480
draw from-image from-image 480x360
draw mouth mouth 480x360
draw mouth mouth-curves 480x360 --curves --view front
draw shoulder-cap shoulder-cap 480x480
draw eye-socket eye-socket 480x400
draw forearm-sheet forearm-sheet 360x480
draw knee-guard knee-guard 360x480 --curves
draw bar-bent bar-bent 480x400 --view front
draw bar-twisted bar-twisted 240x480 --wireframe
draw hand hand 560x400
draw body-posed body-posed 400x640
draw fist fist 560x400
draw teapot teapot 560x320 --view front
# The same without turning detail along: plain Laplacian editing.
draw bar-bent bar-bent-unturned 480x400 --view front --set bent.quality=unturned --set bound.keeps=coordinates
draw bar-twisted bar-twisted-unturned 240x480 --wireframe --set twisted.quality=unturned --set bound.keeps=coordinates
draw hand hand-unturned 560x400 --set bent.quality=unturned --set bound.keeps=coordinates
draw body-posed body-posed-unturned 400x640 --set posed.quality=unturned
draw fist fist-unturned 560x400 --set bent.quality=unturned --set bound.keeps=coordinates
draw teapot teapot-unturned 560x320 --view front --set bent.quality=unturned
draw open-strokes open-strokes 480x400 --curves
for experiment in cantilever supported tyre; do
    "$maquette" render "graphs/experiments/$experiment.ron" -o "docs/pictures/$experiment.png" --size 640x400 --quiet \
        --curves --view front
done
"$maquette" wedge graphs/vest.ron --vary body.k_s=0.2..5:4:log --vary shaped.before=0.05,0.17,0.3 --quiet \
    --sheet docs/pictures/wedge.png --tile 240x280
# Needs a Vulkan driver; Mesa's software one will do (mesa-vulkan-drivers).
cargo run --release -p maquette-editor --example screenshots -- docs/pictures
