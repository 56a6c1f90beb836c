// Kernel that traces the beams from one point of a lamp through the box. Options:
//   ATOMICS        1: the device has 64-bit atomics; else one work-item traces all beams
//   LAMBERT, CONE  1: the lamp is a rectangle (LAMBERT), a spot (CONE)
//   MOMENTS        1: first moments of the deposit are computed
//   NET_FLUX       1: net flux is computed
//   FACE_OUT       1: the power that leaves through each cell of the box's faces is summed
//   VACUUM         1: the lamp is a rectangle that is divided into parts, each of which lights some voxels. The deposit
//                  that the light would have in vacuum is summed too. If an axis is periodic (AROUND is 1), so is the
//                  actual deposit of beams before they wrap around it
//   THIN           below this optical thickness of a voxel, light is taken to be lost uniformly in it
//   IN_BLOCK       1: beams are traced in a block of the grid, and stop where they leave it
//
// Space around the lamp is divided into six pyramids, one for each sense along an axis. In a pyramid beams form a grid
// of tangents, fine enough that a beam is at most a voxel wide where it leaves the box. A beam advances layer by layer;
// its square cross-section overlaps up to four voxels, and each of these is crossed by its share of the power
// (numerics.md, Eqs. (33), (34)). All values are fractions of the traced power, the share of the lamp's power that may
// reach the box (LampOnGrid.h), and apply to all channels, which share sigma_t.

#include "LightPropagation/Uncollided/Lamps/BeamFaces.cl"
#include "LightPropagation/Uncollided/Lamps/BeamPower.cl"
#include "LightPropagation/Uncollided/Lamps/LampBeamsShared.h"
#include "Numerics/FixedPoint.cl"
#include "Numerics/Numerics.cl"

#define STEPS 2 // steps per layer: a beam moves laterally by less than a voxel per step

// Adds first moments: the path integral in a voxel times the mean position of the loss relative to the voxel's centre,
// along the pyramid's axis and laterally (numerics.md, Eqs. (37), (38)).
//   way    start and end of the step, in layers from the beam's start
//   begin  the beam's start, moved aside to the middle of the cross-section's part in the voxel, relative to the
//          voxel's lower edges
static void add_moments(const LampInfo* lamp, const BeamRow* row, float2 way, float2 begin, float2 tangent, float tau,
  float lost, float path, __global long* first_moments, ulong stride)
{
  const float part = tau < 0.05f ? 0.5f - tau / 12.0f : 1.0f / tau - (1.0f - lost) / lost;
  const float at = mix(way.x, way.y, part);
  float from_middle[3];
  const float along = row->from - floor(row->from) + (row->up ? at : -at); // small, so that little is rounded off
  from_middle[0] = along - floor(along) - 0.5f;                            // removes laps around a periodic axis
  from_middle[1] = begin.x + at * tangent.x - 0.5f;
  from_middle[2] = begin.y + at * tangent.y - 0.5f;
  for (int a = 0; a < 3; ++a)
  {
    const float distance = clamp(from_middle[a], -0.5f, 0.5f);
    add_units(first_moments + ((row->axis + a) % 3) * stride, convert_long_sat_rte(path * distance * lamp->scale));
  }
}

// Adds the net flux of a step, i.e. path integral times direction along x, y and z. The step is from way.x to way.y, in
// layers from the beam's start.
static void add_flux(const LampInfo* lamp, const BeamRow* row, float2 tangent, float2 way, float length, float path,
  __global long* flux, ulong stride)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  const float layers = path * lamp->scale * (way.y - way.x) / length;
  add_units(flux + row->axis * stride, convert_long_sat_rte((row->up ? layers : -layers) * lamp->spacing[row->axis]));
  add_units(flux + u * stride, convert_long_sat_rte(layers * tangent.x * lamp->spacing[u]));
  add_units(flux + v * stride, convert_long_sat_rte(layers * tangent.y * lamp->spacing[v]));
}

// Adds to `sums` the path integral that light from the rectangle or one of its nearest periodic images would have in
// vacuum and, if AROUND is 1, the actual path integral of this light.
//   around   number of voxels by which the light has wrapped around the pyramid's axis, u and v
//   counted  actual path integral
static void add_in_vacuum(const LampInfo* lamp, const BeamRow* row, const int* around, float in_vacuum, float counted,
  __global long* sums, ulong stride)
{
  if (is_image(lamp, row->axis, around[0]) && is_image(lamp, (row->axis + 1) % 3, around[1]) &&
    is_image(lamp, (row->axis + 2) % 3, around[2]))
  {
    add_units(sums, convert_long_sat_rte(in_vacuum * lamp->scale));
    if (AROUND)
    {
      add_units(sums + stride, convert_long_sat_rte(counted * lamp->scale));
    }
  }
}

// One step of a beam. Positions along the pyramid's axis are in layers from the beam's start, lateral ones in voxels.
typedef struct
{
  int layer;             // layer of voxels, wrapped around a periodic axis
  float2 begin, tangent; // lateral position at the beam's start, voxels; lateral voxels per layer
  float2 middle, width;  // centre and width of the cross-section half way through the step
  float2 way;            // start and end of the step
  float length;          // path length of the step
} beam_step;

// Cross-section of a beam half way through a step, inside the box. It overlaps up to two voxels along each of u and v.
typedef struct
{
  float2 edgesU, edgesV; // edges along u and v, voxels
  int lowestU, lowestV;  // first voxel that it overlaps
  float partU, partV;    // fraction of the cross-section in the first voxel
} cross_section;

// Power of a beam after a step, summed over the parts of its cross-section. Each part lies in one voxel.
typedef struct
{
  float remaining; // power at the end of the step; the losses `taken` are not subtracted from it
  float taken;     // losses in optically thin voxels
  float waiting;   // share of the remaining power that has not reached the box yet
} step_power;

// Start of a beam, moved aside as far as the middle of the part of its cross-section that lies in its first voxel
// (`next` 0) or in the next one (1) is beside the beam's, relative to that voxel's lower edge. Differences are taken
// near 0: in opaque voxels the depth of a loss is a small part of its place in the box.
static float begin_in_voxel(float begin, float2 edges, float middle, int first, int next)
{
  const float centre = next ? 0.5f * (edges.y + first + 1.0f) : 0.5f * (fmin(edges.y, first + 1.0f) + edges.x);
  const float aside = centre - middle;
  return begin - (first + next) + (fabs(aside) < 1e-5f ? 0.0f : aside);
}

// Attenuates the part of a beam's cross-section that lies in one voxel, and deposits the power lost (numerics.md, Eq.
// (34)).
//   q      which of the four voxels that the cross-section may overlap: bit 0 is the index along u, bit 1 that along v
//   after  sum of the powers of those parts of the cross-section that have already crossed their voxels
// @return the sum including the power of this part
static step_power cross_part(const LampInfo* lamp, const BeamRow* row, const beam_step* step,
  const cross_section* section, int q, const __global float* sigma, __global long* path, ulong stride,
  const BeamOnItsWay* beam, const lamp_tally* tally, step_power after)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  int voxel[3];
  const float part =
    (q & 1 ? 1.0f - section->partU : section->partU) * (q & 2 ? 1.0f - section->partV : section->partV);
  const float power = beam->left * part;
  // If VACUUM is 1, a beam without remaining power continues, because its deposit in vacuum is summed too.
  if ((VACUUM ? part : power) <= 0.0f)
  {
    return after;
  }
  voxel[row->axis] = tally->along;
  voxel[u] = section->lowestU + (q & 1);
  voxel[v] = section->lowestV + (q >> 1);
  const bool counts = tally->counts && is_lit(lamp, row, voxel);
  voxel[row->axis] = step->layer;
  const int at_u = place(lamp, u, step->tangent.x, &voxel[u]);
  const int at_v = place(lamp, v, step->tangent.y, &voxel[v]);
  if (at_u != INSIDE || at_v != INSIDE)
  {
    after.remaining += power; // power that enters the box later, or never
    after.waiting += power;
    return after;
  }
  const ulong index = place_in_arrays(lamp, voxel);
  const float tau = sigma[index] * step->length;
  float through;
  const float lost = extinguished(tau, &through);
  const float mean_length = tau > 1e-20f ? lost / sigma[index] : step->length;
  const float counted = counts ? power * (mean_length * units_of(sigma[index], lamp->diagonal)) : 0.0f;
  if (counted > 0.0f)
  {
    add_units(path + index, convert_long_sat_rte(counted * lamp->scale));
  }
  if (VACUUM && counts)
  {
    const int around[3] = { tally->along - step->layer, section->lowestU + (q & 1) - voxel[u],
      section->lowestV + (q >> 1) - voxel[v] };
    add_in_vacuum(
      lamp, row, around, beam->free * part * step->length, counted, path + FIRST_OF_VACUUM * stride + index, stride);
  }
  if (NET_FLUX)
  {
    add_flux(lamp, row, step->tangent, step->way, step->length, counted, path + FIRST_OF_FLUX * stride + index, stride);
  }
  if (MOMENTS && counts && tau > 0.5f * THIN)
  {
    const float2 begin =
      (float2)(begin_in_voxel(step->begin.x, section->edgesU, step->middle.x, section->lowestU, q & 1),
        begin_in_voxel(step->begin.y, section->edgesV, step->middle.y, section->lowestV, q >> 1));
    add_moments(lamp, row, step->way, begin, step->tangent, tau, lost, counted, path + stride + index, stride);
  }
  const bool thick = lost < 0.5f * tau;
  after.remaining += thick ? power * through : power;
  after.taken += thick ? 0.0f : power * lost;
  return after;
}

// Advances a beam by one step, in which each part of its cross-section crosses its voxel (cross_part). Updates the
// remaining power and its rounding compensation.
// @return power that has not reached the box yet
static float step_beam(const LampInfo* lamp, const BeamRow* row, const beam_step* step, const __global float* sigma,
  __global long* path, ulong stride, BeamOnItsWay* beam, lamp_tally* tally)
{
  const float2 middle = step->middle, width = step->width;
  float2 edges_u = (float2)(middle.x - 0.5f * width.x, middle.x + 0.5f * width.x);
  float2 edges_v = (float2)(middle.y - 0.5f * width.y, middle.y + 0.5f * width.y);
  leave_sides(lamp, row, false, step->tangent, step->way, &edges_u, &edges_v, beam, tally);
  int lowest_u, lowest_v;
  float part_u, part_v;
  overlap(edges_u, &lowest_u, &part_u);
  overlap(edges_v, &lowest_v, &part_v);
  const cross_section section = { edges_u, edges_v, lowest_u, lowest_v, part_u, part_v };
  step_power after = { 0.0f, 0.0f, 0.0f };
  for (int q = 0; q < 4; ++q)
  {
    after = cross_part(lamp, row, step, &section, q, sigma, path, stride, beam, tally, after);
  }
  // Compensated summation: rounding errors of small losses would otherwise accumulate over thousands of steps.
  const float change = beam->rest - after.taken;
  beam->left = after.remaining + change;
  beam->rest = change - (beam->left - after.remaining);
  return after.waiting;
}

// Lower and upper edge of a beam's cross-section along u or v, t layers from its start, voxels.
static float2 edges_at(float start, float tangent, float open, float width, float t)
{
  const float middle = start + tangent * t, half_width = 0.5f * fmin(open + width * t, 1.0f);
  return (float2)(middle - half_width, middle + half_width);
}

// For a beam that starts outside the box: removes the part of its power that misses the face of the box's first layer.
//   start  position of the beam's centre at that face, voxels
static void enter_box(
  const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, BeamOnItsWay* beam, lamp_tally* tally)
{
  float2 edges_u = edges_at(start.x, tangent.x, row->openU, row->widthU, 0.0f);
  float2 edges_v = edges_at(start.y, tangent.y, row->openV, row->widthV, 0.0f);
  leave_sides(lamp, row, true, tangent, (float2)(0.0f), &edges_u, &edges_v, beam, tally);
}

// Fraction of a beam's cross-section along u (k = 0) or v (k = 1) that is inside the box, relative to the part that has
// not left the box.
static float part_inside(const LampInfo* lamp, const BeamRow* row, int k, float tangent, float2 edges)
{
  int up, first;
  cut_at_face(lamp, row, k, tangent, &edges, &up);
  const int axis = (row->axis + 1 + k) % 3;
  float part;
  overlap(edges, &first, &part);
  int second = first + 1;
  return (place(lamp, axis, tangent, &first) == INSIDE ? part : 0.0f) +
    (place(lamp, axis, tangent, &second) == INSIDE ? 1.0f - part : 0.0f);
}

// Fraction of a beam's cross-section that has not reached the box yet, t layers from the beam's start, relative to the
// part that has not left the box.
static float part_to_come(const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, float t)
{
  const float2 edges_u = edges_at(start.x, tangent.x, row->openU, row->widthU, t);
  const float2 edges_v = edges_at(start.y, tangent.y, row->openV, row->widthV, t);
  return 1.0f - part_inside(lamp, row, 0, tangent.x, edges_u) * part_inside(lamp, row, 1, tangent.y, edges_v);
}

// Removes the part of a beam's power that misses the box. Called when a beam that enters through lateral faces has
// reached the layer where the box ends. In its last half step, a fraction of the waiting power still enters the box;
// the remainder is removed.
//   waiting  power that had not reached the box in the middle of the last step, at `here`
static void miss_box(const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, float here, float end,
  float waiting, BeamOnItsWay* beam, lamp_tally* tally)
{
  const float to_come = part_to_come(lamp, row, start, tangent, end);
  const float missed = fmin(waiting * to_come / part_to_come(lamp, row, start, tangent, here), beam->left);
  tally->entered -= tally->counts ? missed : 0.0f;
  beam->left -= missed;
}

#define BEYOND 1 // beyond the voxels that the beam's part of the rectangle illuminates
#define SHORT_OF 2
#define AMID 0

// Position of a beam's centre: AMID the voxels that the beam illuminates, SHORT_OF them, or BEYOND them. A beam from
// one part of a rectangle illuminates only some voxels.
static int stretch_of(const LampInfo* lamp, const BeamRow* row, int along, float2 middle)
{
  int voxel[3];
  voxel[row->axis] = along;
  voxel[(row->axis + 1) % 3] = (int)floor(middle.x);
  voxel[(row->axis + 2) % 3] = (int)floor(middle.y);
  return square_distance(lamp, voxel, row->part) < row->partSeen ? SHORT_OF
    : square_distance(lamp, voxel, row->whole) > row->wholeSeen  ? BEYOND
                                                                 : AMID;
}

// Attenuates a beam over one step through voxels that it does not illuminate, by the extinction at its centre.
// @return whether the whole cross-section is in the box; if it is not, the function does nothing
static bool pass_through(
  const LampInfo* lamp, const BeamRow* row, const beam_step* step, const __global float* sigma, BeamOnItsWay* beam)
{
  const float at[2] = { step->middle.x, step->middle.y };
  const float half_width[2] = { 0.5f * step->width.x, 0.5f * step->width.y };
  int voxel[3];
  voxel[row->axis] = step->layer;
  for (int k = 0; k < 2; ++k)
  {
    const int axis = (row->axis + 1 + k) % 3;
    voxel[axis] = (int)floor(at[k]);
    if (!lamp->periodic[axis] && (at[k] - half_width[k] < 0.0f || at[k] + half_width[k] > lamp->size[axis]))
    {
      return false;
    }
    place(lamp, axis, 0.0f, &voxel[axis]);
  }
  float through;
  extinguished(sigma[place_in_arrays(lamp, voxel)] * step->length, &through);
  beam->left *= through;
  return true;
}

// Tallies the power of a beam that leaves at the far end of its axis, through up to four cells.
//   start  position of the beam's centre at its start, voxels
static void leave_end(
  const LampInfo* lamp, const BeamRow* row, float2 start, float2 tangent, float t, float left, lamp_tally* tally)
{
  if (FACE_OUT + VACUUM == 0)
  {
    tally->escaped[2 * row->axis + row->up] += left;
    return;
  }
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  int voxel[3] = { 0, 0, 0 }, lowest[2];
  float part_u, part_v;
  float2 edges_u = edges_at(start.x, tangent.x, row->openU, row->widthU, t);
  float2 edges_v = edges_at(start.y, tangent.y, row->openV, row->widthV, t);
  int up;
  cut_at_face(lamp, row, 0, tangent.x, &edges_u, &up);
  cut_at_face(lamp, row, 1, tangent.y, &edges_v, &up);
  overlap(edges_u, &lowest[0], &part_u);
  overlap(edges_v, &lowest[1], &part_v);
  for (int q = 0; q < 4; ++q)
  {
    voxel[row->axis] = tally->along;
    voxel[u] = lowest[0] + (q & 1);
    voxel[v] = lowest[1] + (q >> 1);
    const float part = (q & 1 ? 1.0f - part_u : part_u) * (q & 2 ? 1.0f - part_v : part_v);
    const float leaving = is_lit(lamp, row, voxel) ? part * left : 0.0f;
    place(lamp, u, tangent.x, &voxel[u]);
    place(lamp, v, tangent.y, &voxel[v]);
    leave_box(lamp, 2 * row->axis + row->up, voxel, leaving, tally);
  }
}

// Determines the voxel that contains the beam's centre, or the nearest voxel of the grid.
// @return whether this launch traces beams in the voxel at the beam's centre; false: it is outside the block
static bool is_followed(const LampInfo* lamp, const BeamRow* row, int layer, float2 middle, int* voxel)
{
  voxel[row->axis] = layer;
  voxel[(row->axis + 1) % 3] = (int)floor(middle.x);
  voxel[(row->axis + 2) % 3] = (int)floor(middle.y);
  bool followed = true;
  for (int a = 0; a < 3; ++a)
  {
    place(lamp, a, 0.0f, &voxel[a]);
    voxel[a] = clamp(voxel[a], 0, lamp->size[a] - 1);
    followed = followed && voxel[a] >= lamp->followed[a] && voxel[a] < lamp->followedEnd[a];
  }
  return followed;
}

// Layers of voxels that the beams of a row cross, counted along the beams.
typedef struct
{
  int first;  // index of the layer in which the beams start
  int inside; // number of layers from there to the end of the box; on a periodic axis, to the end of its first period
  int all;    // number of layers after which beams are traced no further
  int nearby; // number of layers in which the deposit in vacuum is summed; 0 without VACUUM
} beam_layers;

static beam_layers layers_of(const LampInfo* lamp, const BeamRow* row)
{
  const int n = lamp->size[row->axis];
  const float start = row->from;
  beam_layers layers;
  layers.first =
    row->outside ? (row->up ? 0 : n - 1) : clamp((int)(row->up ? floor(start) : ceil(start) - 1.0f), 0, n - 1);
  layers.inside = row->up ? n - layers.first : layers.first + 1;
  layers.all = lamp->periodic[row->axis] ? row->layers : min(row->layers, layers.inside);
  layers.nearby = VACUUM ? layers.inside + lamp->images[row->axis] * n : 0;
  return layers;
}

static float length_per_layer(const LampInfo* lamp, const BeamRow* row, float2 tangent)
{
  const int u = (row->axis + 1) % 3;
  const int v = (row->axis + 2) % 3;
  const float3 along = (float3)(lamp->spacing[row->axis], tangent.x * lamp->spacing[u], tangent.y * lamp->spacing[v]);
  return sqrt(dot(along, along));
}

// Tallies the remaining power at the end of a beam: power that misses the box, power in transit on a periodic axis, or
// power that escapes at the end of an open axis.
//   here, end  middle of the last step, and end of the last layer, in layers from the beam's start
//   waiting    power that had not reached the box at `here`
static void end_beam(const LampInfo* lamp, const BeamRow* row, float2 begin, float2 tangent, const beam_layers* layers,
  float here, float end, float waiting, BeamOnItsWay* beam, lamp_tally* tally)
{
  if (row->beside && waiting > 0.0f && layers->all >= layers->inside)
  {
    miss_box(lamp, row, begin, tangent, here, end, waiting, beam, tally);
  }
  tally->counts = true;
  if (lamp->periodic[row->axis])
  {
    const float2 middle = begin + tangent * end;
    int voxel[3];
    voxel[row->axis] = tally->along;
    voxel[(row->axis + 1) % 3] = (int)floor(middle.x);
    voxel[(row->axis + 2) % 3] = (int)floor(middle.y);
    tally->stranded += is_lit(lamp, row, voxel) ? beam->left : 0.0f;
  }
  else if (layers->all == layers->inside)
  {
    leave_end(lamp, row, begin, tangent, end, beam->left, tally);
  }
}

// Traces one beam from its entry into the box, or from its saved state, until it leaves.
// @param begin  position of the beam's centre at its start, voxels
// @param power  initial power of the beam
// @return whether the beam has ended; false, only if IN_BLOCK: it has left the block, and its state is in `beam`
static bool follow_beam(const LampInfo* lamp, const BeamRow* row, float2 begin, float2 tangent, float power,
  const __global float* sigma, __global long* path, ulong stride, BeamOnItsWay* beam, lamp_tally* tally)
{
  const int n = lamp->size[row->axis];
  const float per_layer = length_per_layer(lamp, row, tangent);
  const float start = row->from;
  const beam_layers layers = layers_of(lamp, row);
  const int first = layers.first;
  // On a periodic axis beams continue until their power is negligible; on an open axis they leave.
  const float least = lamp->periodic[row->axis] ? 1e-7f * power : 0.0f;
  const int before = beam->layer;
  float now = before == 0 ? 0.0f : row->up ? first + before - start : start - (first - (before - 1));
  bool follows = true;
  float waiting = 0.0f, here = now;
  tally->counts = row->skipped == 0;
  if (before == 0 && beam->step == 0 && row->outside)
  {
    enter_box(lamp, row, begin, tangent, beam, tally);
  }
  for (int k = before; k < layers.all && (beam->left > least || (k < layers.nearby && beam->free > 0.0f)); ++k)
  {
    tally->counts = k >= row->skipped;
    tally->along = row->up ? first + k : first - k;
    const int layer = row->up ? (first + k) % n : ((first - k) % n + n) % n;
    const float end = row->up ? first + k + 1 - start : start - (first - k);
    for (int s = k == before ? beam->step : 0; s < STEPS; ++s)
    {
      const float t0 = now + (end - now) * s / STEPS;
      const float t1 = now + (end - now) * (s + 1) / STEPS;
      here = 0.5f * (t0 + t1);
      const float2 middle = begin + tangent * here;
      // A rank that receives a beam always computes the beam's next step, so that the beam advances even if rounding
      // assigns its voxel to another rank.
      if (IN_BLOCK && !is_followed(lamp, row, layer, middle, beam->voxel) && !follows)
      {
        beam->layer = k;
        beam->step = s;
        tally->counts = true;
        return false;
      }
      follows = false;
      const float2 width = fmin((float2)(row->openU, row->openV) + (float2)(row->widthU, row->widthV) * here, 1.0f);
      const float length = (t1 - t0) * per_layer;
      const int stretch = VACUUM ? stretch_of(lamp, row, tally->along, middle) : AMID;
      if (stretch == BEYOND)
      {
        return true;
      }
      const beam_step step = { layer, begin, tangent, middle, width, (float2)(t0, t1), length };
      if (stretch == SHORT_OF && pass_through(lamp, row, &step, sigma, beam))
      {
        waiting = 0.0f;
        continue;
      }
      waiting = step_beam(lamp, row, &step, sigma, path, stride, beam, tally);
    }
    now = end;
  }
  end_beam(lamp, row, begin, tangent, &layers, here, now, waiting, beam, tally);
  return true;
}

// Sets a beam to its initial state with this power.
static void begin_beam(BeamOnItsWay* beam, float power)
{
  beam->layer = beam->step = 0;
  beam->left = beam->free = power;
  beam->rest = 0.0f;
  beam->stays[0] = beam->stays[1] = 1.0f;
}

static void clear_tally(lamp_tally* tally, __global long* cells)
{
  tally->entered = 0.0f;
  tally->stranded = 0.0f;
  tally->counts = true;
  tally->along = 0;
  for (int face = 0; face < 6; ++face)
  {
    tally->escaped[face] = 0.0f;
  }
  tally->cells = cells;
}

// Writes the tallies of a row or beam, as fractions of the traced power: [entered, escaped through -x to +z, in transit
// at the end, emitted in the beams' directions].
static void write_sums(const lamp_tally* tally, float shone, __global float* sums)
{
  sums[0] = tally->entered;
  for (int face = 0; face < 6; ++face)
  {
    sums[1 + face] = tally->escaped[face];
  }
  sums[7] = tally->stranded;
  sums[8] = shone;
}

// Traces a beam through a block of the grid. `beam` is updated to its state when it has left the block, or ended.
static void follow_in_block(const LampInfo* lamp, const BeamRow* row, BeamOnItsWay* beam, const __global float* sigma,
  __global long* path, ulong stride, __global long* cells, __global float* sums)
{
  lamp_tally tally;
  clear_tally(&tally, cells);
  float shone = 0.0f, power = 0.0f;
  if (!beam->begun || lamp->periodic[row->axis])
  {
    power = power_of_beam(lamp, row, beam->beam);
  }
  if (!beam->begun)
  {
    shone = power;
    tally.entered = row->skipped > 0 ? 0.0f : shone;
    begin_beam(beam, shone);
  }
  // A beam that has already crossed other blocks is traced whatever its remaining power, which may be negative by
  // rounding.
  const bool is_there = beam->begun || shone > 0.0f;
  beam->begun = true;
  beam->ended = !is_there ||
    follow_beam(
      lamp, row, begin_of(row, beam->beam), tangent_of(row, beam->beam), power, sigma, path, stride, beam, &tally);
  write_sums(&tally, shone, sums);
}

static void follow_row(const LampInfo* lamp, const BeamRow* row, const __global float* sigma, __global long* path,
  ulong stride, __global long* cells, __global float* sums)
{
  float shone = 0.0f;
  lamp_tally tally;
  clear_tally(&tally, cells);
  for (int i = 0; i < row->count; ++i)
  {
    const float power = power_of_beam(lamp, row, i);
    if (power > 0.0f)
    {
      BeamOnItsWay beam;
      begin_beam(&beam, power);
      tally.entered += row->skipped > 0 ? 0.0f : power;
      shone += power;
      follow_beam(lamp, row, begin_of(row, i), tangent_of(row, i), power, sigma, path, stride, &beam, &tally);
    }
  }
  write_sums(&tally, shone, sums);
}

// Traces rows of beams through the grid. If IN_BLOCK is 1, traces beams through a block of the grid instead: beams that
// start in the block, and beams that arrive from other blocks.
// path  sums in fixed point, to which the kernel adds: consecutive arrays [voxel of LampInfo::stored]. Path integral,
//       as a fraction of the traced power times length; if MOMENTS, path times distance along x, y and z; if NET_FLUX,
//       path times direction along x, y and z; if VACUUM, the path that light would have in vacuum before it wraps
//       around an axis, and if AROUND the actual path of that light
// cells power that leaves through the box's faces, in fixed point, [cell]; if FACE_OUT
// beams states of the beams, if IN_BLOCK; updated when a beam has left the block or ended
// first, count  index of the first row (IN_BLOCK: beam) of this launch, and number of rows or beams
// sums  tallies, [row or beam][LampRowSums], see write_sums()
__kernel void follow_lamp(LampInfo lamp, const __global float* sigma, ulong sigma_first, __global long* path,
  ulong stride, __global long* cells, const __global BeamRow* rows, __global BeamOnItsWay* beams, int first, int count,
  __global float* sums)
{
  const int begin = ATOMICS ? first + get_global_id(0) : first, end = ATOMICS ? begin + 1 : first + count;
  for (int i = begin; i < end; ++i)
  {
    if (IN_BLOCK)
    {
      BeamOnItsWay beam = beams[i];
      const BeamRow row = rows[beam.row];
      follow_in_block(&lamp, &row, &beam, sigma + sigma_first, path, stride, cells, sums + i * LampRowSums);
      beams[i] = beam;
    }
    else
    {
      const BeamRow row = rows[i];
      follow_row(&lamp, &row, sigma + sigma_first, path, stride, cells, sums + i * LampRowSums);
    }
  }
}
