#!/usr/bin/env bash
# Draws the ways of drawing for docs/STYLE.md: scripts/draw_modes.sh LIDAR.stipple CLASSIFIED.stipple NORMALS.stipple
#   LIDAR        a coloured airborne scan in feet: the docs show autzen
#   CLASSIFIED   one with classes, returns and times: the docs show an IGN tile
#   NORMALS      one with normals: the docs show `stipple synth --points 2000000 --normals`
# Writes docs/pictures/modes/NAME.png, 400 × 250 pixels. Needs the program that scripts/test.sh builds. Lines of the list:
# a, b or n, the cloud|name|style as JSON|further options
set -euo pipefail
[ $# = 3 ] || { echo "usage: scripts/draw_modes.sh LIDAR.stipple CLASSIFIED.stipple NORMALS.stipple" >&2; exit 2; }
a=$(realpath "$1") b=$(realpath "$2") n=$(realpath "$3")
cd "$(dirname "$0")/.."
stipple=${STIPPLE:-build/release/client/headless/stipple}
out=docs/pictures/modes
mkdir -p "$out"
near='{"position": [636700, 850200, 760], "target": [637200, 851000, 420]}'
trees='{"position": [484935, 6632905, 165], "target": [484845, 6632775, 105]}'
houses='{"position": [499985, 5399955, 22], "target": [500020, 5400010, 6]}'
while IFS='|' read -r which name style options; do
  case $which in
    a) cloud=$a view=$near ;;
    b) cloud=$b view=$trees ;;
    n) cloud=$n view=$houses ;;
  esac
  # shellcheck disable=SC2086
  "$stipple" render "$cloud" -o "$out/$name.png" --size 400x250 --view "$view" --style "$style" $options >/dev/null
done <<'LIST'
a|default|{}|
a|no_lighting|{"edl": {"enabled": false}}|
a|lighting_4|{"edl": {"neighbours": 4, "radiusPixels": 2}}|
a|pixels|{"shape": "square", "sizePixels": 1, "edl": {"enabled": false}}|--budget 200000
a|squares|{"shape": "square", "sizePixels": 4, "edl": {"enabled": false}}|
a|circles|{"shape": "circle", "sizePixels": 4, "edl": {"enabled": false}}|
a|paraboloids|{"shape": "paraboloid", "sizePixels": 8, "edl": {"enabled": false}}|
n|discs|{"shape": "disc", "sizeMode": "world", "sizeWorld": 0.5, "edl": {"enabled": false}}|--budget 3000000
n|discs_circles|{"shape": "circle", "sizeMode": "world", "sizeWorld": 0.5, "edl": {"enabled": false}}|--budget 3000000
a|splats|{"splats": {"enabled": true}, "sizePixels": 6, "edl": {"enabled": false}}|
a|world_size|{"sizeMode": "world", "sizeWorld": 12, "edl": {"enabled": false}}|--budget 200000
a|adaptive_size|{"sizeMode": "adaptive", "sizeSpacings": 2, "edl": {"enabled": false}}|--budget 200000
a|continuous|{"detail": {"mode": "continuous", "spacingPixels": 2}, "sizeMode": "spacing", "sizeSpacings": 2, "edl": {"enabled": false}}|
a|delayed_expansion|{"delayedExpansion": "on", "sizePixels": 3}|
a|intensity|{"colourMode": "intensity", "gradient": "grey", "edl": {"strength": 0.15}}|
a|elevation_viridis|{"colourMode": "elevation", "gradient": "viridis"}|
a|elevation_turbo|{"colourMode": "elevation", "gradient": "turbo"}|
a|elevation_inferno|{"colourMode": "elevation", "gradient": "inferno"}|
a|elevation_spectral|{"colourMode": "elevation", "gradient": "spectral"}|
a|elevation_terrain|{"colourMode": "elevation", "gradient": "terrain"}|
b|classification|{"colourMode": "classification"}|
b|return_number|{"colourMode": "returnNumber", "gradient": "turbo"}|
b|number_of_returns|{"colourMode": "numberOfReturns", "gradient": "turbo"}|
b|point_source|{"colourMode": "pointSourceId", "gradient": "spectral"}|
b|gps_time|{"colourMode": "gpsTime"}|
b|level|{"colourMode": "level", "gradient": "turbo"}|
b|attribute|{"colourMode": "attribute", "attribute": "Scan Angle", "gradient": "spectral"}|
b|mix|{"colourMode": "mix", "mix": [{"colourMode": "rgb", "weight": 1}, {"colourMode": "classification", "weight": 1}]}|
b|hidden_classes|{"colourMode": "classification", "hiddenClasses": [3, 4, 5]}|
b|filter|{"filters": [{"attribute": "Return Number", "min": 2}]}|
b|clip_highlight|{"clipBoxes": [{"mode": "highlight", "centre": [484850, 6632760, 110], "halfSize": [50, 30, 20], "rotation": [0, 0, 0.3827, 0.9239]}]}|
b|clip_outside|{"clipBoxes": [{"mode": "hideOutside", "centre": [484850, 6632760, 110], "halfSize": [50, 30, 20], "rotation": [0, 0, 0.3827, 0.9239]}]}|
b|clip_inside|{"clipBoxes": [{"mode": "hideInside", "centre": [484850, 6632760, 110], "halfSize": [50, 30, 20], "rotation": [0, 0, 0.3827, 0.9239]}]}|
b|clip_polygon|{"clipRegions": [{"mode": "hideOutside", "region": {"polygon": [[484770, 6632700], [484890, 6632760], [484930, 6632850], [484860, 6632850], [484850, 6632790], [484770, 6632800]], "holes": [[[484860, 6632770], [484885, 6632785], [484895, 6632825], [484870, 6632820]]], "heights": [null, 125]}}]}|
b|clip_corridor|{"clipRegions": [{"mode": "highlight", "region": {"line": [[484780, 6632730], [484850, 6632760], [484910, 6632850]], "width": 14}}]}|
LIST
