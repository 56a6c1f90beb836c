// Traces a lamp's beams through one block of a grid: those that start in it, and those that arrive from other blocks.
// Options as for LampBeams.cl.

#define IN_BLOCK 1
#include "LightPropagation/Uncollided/Lamps/LampBeams.cl"

static void follow_in_block(const LampInfo* lamp, const BeamRow* row, BeamOnItsWay* beam, const __global float* sigma,
  __global long* path, ulong stride, __global long* cells, __global float* sums)
{
  lamp_tally tally;
  clear_tally(&tally, cells);
  beam_state state = { beam->layer, beam->step, beam->left, beam->rest, { beam->stays[0], beam->stays[1] },
    beam->free };
  float shone = 0.0f, power = 0.0f;
  if (!beam->begun || lamp->periodic[row->axis])
  {
    power = power_of_beam(lamp, row, beam->beam);
  }
  if (!beam->begun)
  {
    shone = power;
    tally.entered = row->skipped > 0 ? 0.0f : shone;
    state = beam_of(shone);
  }
  // The remaining power of a beam that has already travelled may be negative by rounding.
  const bool is_there = beam->begun || shone > 0.0f;
  beam->begun = true;
  beam->ended = !is_there ||
    follow_beam(
      lamp, row, begin_of(row, beam->beam), tangent_of(row, beam->beam), power, sigma, path, stride, &state, &tally);
  beam->layer = state.layer;
  beam->step = state.step;
  beam->left = state.left;
  beam->rest = state.rest;
  beam->stays[0] = state.stays[0];
  beam->stays[1] = state.stays[1];
  beam->free = state.free;
  for (int a = 0; a < 3 && !beam->ended; ++a)
  {
    beam->voxel[a] = state.voxel[a];
  }
  write_sums(&tally, shone, sums);
}

// sigma, path, stride, cells, rows  as in follow_lamp, for the stored voxels of LampInfo
// beams  replaced by their state when they have left the block, or ended
// sums   [beam], see write_sums()
__kernel void follow_lamp_in_block(LampInfo lamp, const __global float* sigma, ulong sigma_first, __global long* path,
  ulong stride, __global long* cells, const __global BeamRow* rows, __global BeamOnItsWay* beams, int count,
  __global float* sums)
{
#if ATOMICS
  const int b = get_global_id(0);
#else
  for (int b = 0; b < count; ++b)
#endif
  {
    BeamOnItsWay beam = beams[b];
    const BeamRow row = rows[beam.row];
    follow_in_block(&lamp, &row, &beam, sigma + sigma_first, path, stride, cells, sums + b * LampRowSums);
    beams[b] = beam;
  }
}
