#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# report_images.sh VERSINE FOLDER: pages of reports as pictures for the documentation, with times and sizes.
set -eu
versine=$1 images=$2
out=out/report
mkdir -p $out "$images"
limits=$PWD/data/limits

page() {  # page RESULT NUMBER NAME
  pdftoppm -r 96 -f "$2" -l "$2" -singlefile -png "$1/report.pdf" "$images/report-$3"
}
report() {  # report RESULT: makes all formats; user time and sizes
  for format in html pdf xlsx; do
    /usr/bin/time -f "$1: $format %U s user, %M kB" "$versine" report "$1" --format $format --quiet
  done
  ls -l "$1"/report.* | awk '{ print "  " $9 ": " $5 " bytes" }'
}

"$versine" simulate examples/scenarios/slab-1km.toml -o $out/demo/recording
"$versine" survey $out/demo/recording/survey.toml -o $out/demo/result --quiet \
  --set "geometry.quality.limits=\"$limits/china-ballastless.toml\"" --set geometry.quality.speed_kmh=300 \
  --set geometry.adjustment.on=true
report $out/demo/result
page $out/demo/result 1 demo-cover
page $out/demo/result 9 demo-strips

"$versine" simulate examples/scenarios/line-10km.toml -o $out/10km/recording
"$versine" survey $out/10km/recording/survey.toml -o $out/10km/result --quiet \
  --set "geometry.quality.limits=\"$limits/en13848-5.toml\"" --set geometry.quality.speed_kmh=120
report $out/10km/result
page $out/10km/result 2 10km-overview

if [ -n "${VERSINE_DATA:-}" ]; then
  "$versine" georef examples/georef/brussels.toml -o $out/brussels/result --quiet
  report $out/brussels/result
  page $out/brussels/result 5 brussels
fi
