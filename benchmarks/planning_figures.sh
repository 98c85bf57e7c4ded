#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The pictures of docs/planning.md: benchmarks/planning_figures.sh VERSINE docs/images
set -e
versine=$1 images=$2
jobs=$(dirname "$0")/../examples/plan
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$images"
plan() { # plan JOB PICTURE NAME
  "$versine" plan "$jobs/$1.toml" --quiet --set maps.points=25 -o "$scratch/$3" || [ $? -eq 1 ] # 1: the requirement is not met
  cp "$scratch/$3/$2.svg" "$images/planning-$3.svg"
}
plan jiang_figure5 sigma figure5
plan jiang_rlg maps figure6
plan jiang_rlg monte_carlo figure7-rlg
plan jiang_fog monte_carlo figure7-fog
plan jiang_figure8 methods figure8
