#!/bin/bash
# Draws the figures of problems/README.md and docs/studies.md anew:  bash problems/figures/draw.sh [PROGRAM]   (default: ./elamin)
# A line for each: the problem, with :NAME for another figure of it; whose results, "." or of a sweep the run whose name begins so; what `elamin plot` is told.
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../../elamin}")
cd "$(dirname "$0")"
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

while read -r problem run options; do
  name=$(basename "${problem/:/_}")
  directory=$results/$name
  "$program" "../${problem%%:*}.toml" -o "$directory" --threads 1 --quiet
  [ "$run" = . ] || directory=$(echo "$directory/$run"_*)
  # shellcheck disable=SC2086
  "$program" plot "$directory" $options --out "$name.svg"
done <<'LIST'
column_cylindrical . --x deflection --y force --shapes initial,branch:1+mode,final
column_square . --x lambda --y deflection --shapes initial,branch:1+mode,final
buckling_strain_cylindrical .
buckling_strain_square .
hencky_hinged . --shapes branch:1+mode,branch:2+mode,branch:3+mode
column_curve .
column_landscape . --shapes minimum-2-0-5,saddle-2-0-5
hencky_clamped . --shapes branch:1+mode,branch:2+mode,branch:3+mode,branch:4+mode
elastica 1 --x force --y distance --shapes initial,final
elastica_touches 3 --y force --shapes initial,contact:1
cantilever_tip_load 1 --x lambda --y w --shapes final
cantilever_tip_load:levels .
greenhill_mast 1 --no-diagram --shapes initial,branch:1+mode
column_self_contact . --x deflection --y force --shapes initial,final
column_between_walls . --y force --shapes initial,final
column_imperfect 1 --x deflection --y lambda --shapes final
column_random . --x deflection --y lambda --shapes initial,final
column_measured . --no-diagram --shapes final
column_tapered . --no-diagram --shapes branch:1+mode,branch:2+mode,branch:3+mode,branch:4+mode
beam_in_tube . --y tube_force --shapes initial,final
truss_low . --x height --y lambda --shapes initial,limit:1,final
truss_tall . --x height --y lambda --shapes initial,branch:1+mode,final
truss_curve . --shapes initial,branch:1+mode
truss_landscape . --x lambda --y energy --shapes minimum-1-0-01,saddle-1-0-01,minimum-2-0-01
truss_spring 1 --x height --y force --shapes initial,final
truss_three_bars . --no-diagram --shapes final
chain_hanging . --no-diagram --shapes final
helix_spring 1 --no-diagram --shapes final
spiral_spring . --no-diagram --shapes final
meander_spring . --x stretch --y lambda --shapes initial,final
lee_frame 1 --x v --y lambda --shapes initial,limit:1,limit:2,final
williams_toggle 1 --x w --y lambda --shapes initial,limit:1,final
arch_low . --x w --y lambda --shapes initial,limit:1,final
arch_sine 2 --x height --y lambda --shapes initial,branch:1+mode,final
arch_curve .
arch_landscape . --x lambda --y barrier --shapes minimum-1-0-35,saddle-1-0-35,minimum-2-0-35
arch_deep 1 --x v --y lambda --shapes initial,limit:1,final
arch_buckled . --y height --shapes initial,compression,limit:1,final
arch_flipped . --y height --shapes initial,compression,branch:1+mode,final
ring_pressure 1 --no-diagram --shapes initial,branch:1+mode
ring_pressure_links . --no-diagram --shapes initial,branch:1+mode
ring_radial_forces 1 --no-diagram --shapes initial,branch:1+mode
ring_pinched . --x highest --y force --shapes initial,final
ring_between_plates 1 --x lowering --y force --shapes initial,final
loop_squeezed . --x upper_gap --y upper_force --shapes initial,final
plate_hinged 1 --no-diagram --shapes branch:1+mode
plate_clamped 1 --no-diagram --shapes branch:1+mode
plate_growing 1 --no-diagram --shapes branch:1+mode
plate_post_buckling 1 --y force --shapes final
disc_clamped . --no-diagram --shapes branch:1+mode
disc_hinged . --no-diagram --shapes branch:1+mode
plate_pressure 1 --no-diagram --shapes final
tube_pressure . --no-diagram --shapes final
sheet_indented . --x deflection --y force --shapes final
confined_d_cone . --y push --shapes final
two_beams . --y gap --shapes initial,branch:1,contact:1,limit:1,final
two_beams_landscape . --shapes minimum-1-0-9,minimum-2-0-9
two_beams_gaps .
two_beams_law . --y second
two_beams_winner . --y thin_x
hertz_pair . --x driven_gap --y driven_force --shapes initial,final
ball_on_rods . --no-diagram --shapes final
grain_column .
grain_corner .
boxes_stacked .
rod_leaning .
box_tips . --x tilt --y lambda --shapes initial,limit:1,final
cubes_cohesive . --x z --y lambda --shapes initial,final
cubes_jammed . --shapes initial,final
cube_dropped . --y height --shapes initial,final
column_hard_walls . --y force --shapes initial,final
ring_hard_plates . --x lambda --y force --shapes initial,final
grains_relax .
grain_bounces . --y height
grains_settle . --y kinetic --shapes initial,final
column_swings . --y deflection --shapes initial,final
studies/grain_beam . --y force --shapes initial,final
studies/on_top_glued . --no-diagram --shapes final
LIST
