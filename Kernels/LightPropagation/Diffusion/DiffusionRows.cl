// Kernels of the diffusion system of one channel (DiffusionSystem.h) that process rows of voxels in vectors: its
// matrix, and its right-hand side from the results of a sweep, except for terms of the box's faces
// (DiffusionSystem.cl). Options:
//   REAL_WIDTH  number of floats in a vector, 4 or 8; 1: one voxel per work-item, on a GPU
//   GROUP       number of work-items that sum together (GroupSum.cl)
//   DOUBLES     1: the device has double precision
//
// Arrays of the sweeps are [voxel], x fastest and without gaps; reads may extend one vector beyond a row's end. Arrays
// "in rows" have the layout of MultigridLevel, with ghosts and padding between rows. The low face of the first voxel of
// a row is processed separately: the voxel before it in memory is not its neighbour.

#include "LightPropagation/Diffusion/Conductance.cl"
#include "LightPropagation/Diffusion/MultigridRows.cl"
#include "Numerics/Exact.cl"

// Index of the first voxel of the row (y, z) in an array [voxel].
inline int voxel_at(const DiffusionLayout* layout, int y, int z)
{
  return (z * layout->size[1] + y) * layout->size[0];
}

// Contiguous range of voxels of a row whose low faces, perpendicular to an axis, are not on the box's boundary.
typedef struct
{
  int begin, end; // range of x of the voxels
  int before;     // index, in an array [voxel], of the voxel behind the low face at x = 0; for other x, add x
} face_span;

// Finds all face_spans of a row. There are none on the box's boundary. For faces perpendicular to x, the first span is
// the face that wraps around a periodic axis, the second all other faces. The last vector of a span writes beyond its
// end, so spans must be processed in order. @return number of spans
inline int find_spans(const DiffusionLayout* layout, int axis, int y, int z, face_span* spans)
{
  const int n = layout->size[0], here = voxel_at(layout, y, z);
  const bool round = layout->periodic[axis] && layout->size[axis] > 1;
  if (axis == 0)
  {
    const face_span first = { 0, round ? 1 : 0, here + n - 1 }, others = { 1, n, here - 1 };
    spans[0] = first;
    spans[1] = others;
    return 2;
  }
  const bool begins = (axis == 1 ? y : z) == 0;
  const int before_y = axis == 1 ? (begins ? layout->size[1] : y) - 1 : y;
  const int before_z = axis == 2 ? (begins ? layout->size[2] : z) - 1 : z;
  const face_span all = { 0, begins && !round ? 0 : n, voxel_at(layout, before_y, before_z) };
  spans[0] = all;
  return 1;
}

// Stores a vector of values from voxel x of a row on, in an array [voxel]. SIMD lanes beyond the row's end are not
// stored.
inline void store_in_row(real values, int x, int size, __global float* row)
{
  if (x + REAL_WIDTH <= size)
  {
    store_real(values, x, row);
    return;
  }
  float parts[REAL_WIDTH];
  *(real*)parts = values;
  for (int k = 0; x + k < size; ++k)
  {
    row[x + k] = parts[k];
  }
}

// Computes flat_source_current() (Conductance.cl) of each voxel along each axis.
//   flat_source  [axis][voxel], axes flatStride floats apart
//   swept        extinction that sweeps use, 1/length
//   nodes        [axis][node], `count` for each axis
__kernel void diffusion_flat_source(DiffusionLayout layout, const __global float* sigma_t, const __global float* swept,
  const __global FlatSourceNode* nodes, int count, __global float* flat_source)
{
  sigma_t += layout.firstT;
  swept += layout.firstT;
  FOR_ROWS(layout.rows)
  {
    const int here = r * layout.size[0];
    FOR_VECTORS(x, 0, layout.size[0])
    {
      const real sweeps = load_real(x, swept + here);
      for (int axis = 0; axis < (layout.flatStride > 0 ? 3 : 1); ++axis)
      {
        real current = flat_source_current(sweeps, layout.spacing[axis], nodes + axis * count, count);
        if (layout.moments)
        {
          // A fraction of the current is due to the source's first moment, and is exact. Only the rest of the current
          // is too large because the source is constant in each voxel, Eq. (51).
          const real rest = fmin(load_real(x, sigma_t + here) / fmax(sweeps, (real)1e-37f), (real)1.0f);
          const real part = select((real)1.0f, rest, sweeps > (real)0.0f);
          current = 1.0f / 6.0f + part * (current - 1.0f / 6.0f);
        }
        store_in_row(current, x, layout.size[0], flat_source + (ulong)axis * layout.flatStride + here);
      }
    }
  }
}

// Conductance of the faces between voxels 0 and their neighbours 1 along an axis, length^2 (D of numerics.md, Eq.
// (57)).
static real conductance_of(
  const DiffusionLayout* layout, int axis, real sigma_t0, real sigma_a0, real sigma_t1, real sigma_a1, real flat_source)
{
  const float h = layout->spacing[axis];
  const real tau0 = sigma_t0 * h, tau1 = sigma_t1 * h;
  const real y0 = half_diffusion_length(tau0, sigma_t0, sigma_a0);
  const real y1 = half_diffusion_length(tau1, sigma_t1, sigma_a1);
  return face_area(layout, axis) * pass_face(layout, tau0, tau1, y0, y1, flat_source);
}

// Computes the matrix of the diffusion system, without the loss through the box's faces.
//   conductance  of each voxel's low face, length^2, [axis] in the row layout of MultigridLevel; 0 on the box's
//                boundary
//   loss         absorbed power per fluence, length^2, in the row layout
__kernel void diffusion_conductance(DiffusionLayout layout, const __global float* sigma_t,
  const __global float* sigma_a, const __global float* flat_source, __global float* conductance, __global float* loss)
{
  sigma_t += layout.firstT;
  sigma_a += layout.first;
  const int n = layout.size[0];
  FOR_ROWS(layout.rows)
  {
    const int y = r % layout.size[1], z = r / layout.size[1], here = voxel_at(&layout, y, z);
    const int row = row_at(&layout.rows, y, z);
    FOR_VECTORS(x, 0, n)
    {
      store_real(in_row(load_real(here + x, sigma_a) * volume_of(&layout), n - x), x, loss + row);
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      __global float* passes = conductance + axis * layout.rows.floats + row;
      const __global float* flat = flat_source + (ulong)axis * layout.flatStride;
      face_span spans[2];
      const int count = find_spans(&layout, axis, y, z, spans);
      for (int s = 0; s < count; ++s)
      {
        FOR_VECTORS(x, spans[s].begin, spans[s].end)
        {
          const int i = here + x, j = spans[s].before + x;
          const real value = conductance_of(&layout, axis, load_real(j, sigma_t), load_real(j, sigma_a),
            load_real(i, sigma_t), load_real(i, sigma_a), load_real(j, flat) + load_real(i, flat));
          store_real(in_row(value, spans[s].end - x), x, passes);
        }
      }
    }
    FILL_GHOSTS(conductance + row, n);
  }
}

// Copies sigma_t to an array in rows (MultigridLevel). A row's ghosts (the floats before and after it), if they lie
// beyond the box's boundary, get the value of the outermost voxel, so that contrast() is 0 at the boundary.
__kernel void diffusion_extinction(DiffusionLayout layout, const __global float* sigma_t, __global float* extinction)
{
  sigma_t += layout.firstT;
  const int n = layout.size[0];
  FOR_ROWS(layout.rows)
  {
    const __global float* from = sigma_t + r * n;
    __global float* row = extinction + row_at(&layout.rows, r % layout.size[1], r / layout.size[1]);
    FOR_VECTORS(x, 0, n)
    {
      store_real(load_real(x, from), x, row);
    }
    if (ENDS_ROW(n))
    {
      row[-1] = from[layout.periodic[0] ? n - 1 : 0];
      row[n] = from[layout.periodic[0] ? 0 : n - 1];
    }
  }
}

// Loads the extinction of a vector of voxels from x on, to sigma_t[0], and of their neighbours across face d, to
// sigma_t[1 + d].
static void find_extinctions(
  const DiffusionLayout* layout, int y, int z, int x, const __global float* extinction, real* sigma_t)
{
  const MultigridLevel* rows = &layout->rows;
  const int last_y = layout->size[1] - 1, last_z = layout->size[2] - 1;
  const int low_y = y > 0 ? y - 1 : layout->periodic[1] ? last_y : 0;
  const int high_y = y < last_y ? y + 1 : layout->periodic[1] ? 0 : last_y;
  const int low_z = z > 0 ? z - 1 : layout->periodic[2] ? last_z : 0;
  const int high_z = z < last_z ? z + 1 : layout->periodic[2] ? 0 : last_z;
  const int here = row_at(rows, y, z) + x;
  sigma_t[0] = load_real(here, extinction);
  sigma_t[1] = load_real(here - 1, extinction);
  sigma_t[2] = load_real(here + 1, extinction);
  sigma_t[3] = load_real(row_at(rows, low_y, z) + x, extinction);
  sigma_t[4] = load_real(row_at(rows, high_y, z) + x, extinction);
  sigma_t[5] = load_real(row_at(rows, y, low_z) + x, extinction);
  sigma_t[6] = load_real(row_at(rows, y, high_z) + x, extinction);
}

// Degree to which voxels are the skin, i.e. the surface layer, of a thick region (numerics.md, section 7.5), 0 to 1:
// the largest contrast() of a voxel's faces, 0 if that is below 0.01. Nonzero only next to thinner voxels.
static real skin_of(const DiffusionLayout* layout, const real* sigma_t)
{
  real most = (real)0.0f;
#pragma unroll
  for (int d = 0; d < 6; ++d)
  {
    const float h = layout->spacing[d / 2];
    most = fmax(most, contrast(sigma_t[0] * h, sigma_t[1 + d] * h));
  }
  return layout->linear ? select((real)0.0f, most, most > (real)0.01f) : (real)0.0f;
}

// Marks the rows that contain voxels with a nonzero skin_of().
//   skins  [z][y], ThickSkin, OpaqueSkin or EndlessSkin; initially NoSkin
__kernel void diffusion_skins(DiffusionLayout layout, const __global float* extinction, __global int* skins)
{
  FOR_ROWS(layout.rows)
  {
    const int y = r % layout.size[1], z = r / layout.size[1];
    const real edge = (real)fmax(layout.spacing[0], fmax(layout.spacing[1], layout.spacing[2]));
    real most = (real)0.0f, opaque = (real)0.0f, endless = (real)0.0f;
    FOR_VECTORS(x, 0, layout.size[0])
    {
      real sigma_t[7];
      find_extinctions(&layout, y, z, x, extinction, sigma_t);
      const real skin = in_row(skin_of(&layout, sigma_t), layout.size[0] - x);
      most = fmax(most, skin);
      opaque = fmax(opaque, select((real)0.0f, skin, sigma_t[0] * edge > (real)100.0f));
      endless = fmax(endless, select((real)0.0f, skin, sigma_t[0] * edge > (real)1e9f));
    }
    if (sum_of(most) > 0.0f)
    {
      skins[r] = sum_of(endless) > 0.0f ? EndlessSkin : sum_of(opaque) > 0.0f ? OpaqueSkin : ThickSkin;
    }
  }
}

// Loads a vector of `exact` values (double precision where the device has it, Exact.cl) from voxel x of a row on,
// rounded to floats; SIMD lanes beyond the row's end repeat its last voxel.
static real load_rounded(const __global exact* row, int x, int size)
{
  float values[REAL_WIDTH];
  for (int k = 0; k < REAL_WIDTH; ++k)
  {
    values[k] = (float)row[min(x + k, size - 1)];
  }
  return *(real*)values;
}

// Computes the fluence m of numerics.md, Eq. (56). Diffusion's power through each face is computed from it, and
// compared with the sweep's power. In thin voxels m is the fluence of the sweep, in optically thick ones the fluence
// from which the sweep's source was computed.
//   extinction  sigma_t, in the row layout as diffusion_extinction writes it or, if DiffusionLayout::skin is 0, [voxel]
//   swept       extinction that sweeps use, 1/length
//   of_lamps    first-collision source of lamps, W / (length^3 sr); read only if DiffusionLayout::passing is 1
//   model       W / length^2, [voxel]
__kernel void diffusion_model(DiffusionLayout layout, const __global float* extinction, const __global float* path,
  const __global exact* fluence, const __global float* source, const __global float* of_lamps,
  const __global float* swept, __global float* model)
{
  path += layout.first;
  source += layout.first;
  of_lamps += layout.first;
  const float edge = fmax(layout.spacing[0], fmax(layout.spacing[1], layout.spacing[2]));
  const int n = layout.size[0];
  FOR_ROWS(layout.rows)
  {
    const int y = r % layout.size[1], z = r / layout.size[1], here = voxel_at(&layout, y, z);
    FOR_VECTORS(x, 0, n)
    {
      const real solved = load_rounded(fluence + here, x, n);
      real given = solved, longest;
      if (layout.skin)
      {
        real sigma_t[7];
        find_extinctions(&layout, y, z, x, extinction, sigma_t);
        const real skin = skin_of(&layout, sigma_t);
        real source_of_fluence = load_real(here + x, source);
        if (layout.passing)
        {
          // The solved fluence does not include light of the lamps' first-collision source, so that source is
          // subtracted.
          source_of_fluence -= load_real(here + x, of_lamps);
        }
        const real shining =
          4.0f * M_PI_F * source_of_fluence / fmax(load_real(layout.firstT + here + x, swept), (real)1e-37f);
        given = select(solved, mix(solved, shining, skin), skin > (real)0.0f);
        longest = sigma_t[0] * edge;
      }
      else
      {
        longest = load_real(layout.firstT + here + x, extinction) * edge;
      }
      const real found = load_real(here + x, path) / volume_of(&layout);
      const real thick = layout.linear ? 1.0f - 1.0f / (1.0f + longest * longest) : (real)0.0f;
      const real value = select(found + thick * (given - found), given, longest > (real)1e9f);
      store_in_row(value, x, n, model + here);
    }
  }
}

// Arrays of a channel, [voxel], from which the power through the faces perpendicular to one axis is computed.
typedef struct
{
  const __global float *sigma_t, *sigma_a, *flatSource, *model;
  // Power that entered voxels in the sweep through their low faces, and through their high faces, W
  const __global float *low, *high;
  // Power of lamps' first-scattered light that leaves through the low faces, and through the high faces, W.
  const __global float *passedLow, *passedHigh;
  const __global float* givenFlux;
} face_arrays;

// Power from voxels j to their next neighbours i along the axis, W, without the part that is proportional to the
// difference of their fluences (numerics.md, Eqs. (53a), (54)). It is the sum of the transport correction R
// (remainder_of()), the power due to the net flux of the known source (emission and first collisions), and the
// first-scattered light of lamps.
static real power_of_faces(
  const DiffusionLayout* layout, const face_arrays* of, int axis, int j, int i, real passes, real crossing)
{
  inner_face face = { { load_real(j, of->sigma_t), load_real(i, of->sigma_t) },
    { load_real(j, of->sigma_a), load_real(i, of->sigma_a) },
    { load_real(j, of->flatSource), load_real(i, of->flatSource) },
    { load_real(j, of->model), load_real(i, of->model) }, passes, load_real(i, of->low) - load_real(j, of->high),
    (real)0.0f, crossing };
  if (layout->moments)
  {
    const float per_flux = 1.5f * layout->spacing[axis] * (4.0f * M_PI_F);
    face.driven = passes * per_flux * (load_real(j, of->givenFlux) + load_real(i, of->givenFlux));
  }
  real power = remainder_of(layout, axis, &face) + face.driven;
  if (layout->passing)
  {
    power += load_real(j, of->passedHigh) - load_real(i, of->passedLow);
  }
  return power;
}

// Computes power_of_faces() for the voxels' low faces: powers_x, powers_y, powers_z, W, in the row layout of
// MultigridLevel; 0 at the box's boundary.
//   currents  power that entered voxels in the sweep, W, [-x, +x, -y, +y, -z, +z][voxel]
//   passed    power of lamps' first-scattered light that leaves through each face, W, in the layout of `currents`; read
//             only if DiffusionLayout::passing is 1
//   pattern   tables of the crossing pattern: power of the rays that cross a face, relative to the mean
//             (SweepModel.h)
__kernel void diffusion_face_powers(DiffusionLayout layout, const __global float* sigma_t,
  const __global float* sigma_a, const __global float* flat_source, const __global float* conductance,
  const __global float* currents, const __global float* passed, const __global float* model,
  const __global float* pattern, const __global float* given_flux, __global float* powers_x, __global float* powers_y,
  __global float* powers_z)
{
  const ulong stride = layout.stride;
  currents += 6 * (ulong)layout.first;
  passed += layout.passing ? 6 * (ulong)layout.first : 0;
  given_flux += layout.moments ? 3 * (ulong)layout.first : 0;
  const int n = layout.size[0];
  FOR_ROWS(layout.rows)
  {
    const int y = r % layout.size[1], z = r / layout.size[1], here = voxel_at(&layout, y, z);
    const int row = row_at(&layout.rows, y, z);
    for (int axis = 0; axis < 3; ++axis)
    {
      const __global float* low = currents + 2 * axis * stride;
      const __global float* passed_low = passed + (layout.passing ? 2 * axis * stride : 0);
      const face_arrays arrays = { sigma_t + layout.firstT, sigma_a + layout.first,
        flat_source + (ulong)axis * layout.flatStride, model, low, low + stride, passed_low,
        passed_low + (layout.passing ? stride : 0), given_flux + (layout.moments ? axis * stride : 0) };
      const __global float* passes = conductance + axis * layout.rows.floats + row;
      const __global float* along_x = pattern + layout.pattern[2 * axis];
      const float of_row = pattern[layout.pattern[2 * axis + 1] + (axis == 2 ? y : z)];
      __global float* out = (axis == 0 ? powers_x : axis == 1 ? powers_y : powers_z) + row;
      FOR_VECTORS(x, 0, n)
      {
        store_real((real)0.0f, x, out);
      }
      face_span spans[2];
      const int count = find_spans(&layout, axis, y, z, spans);
      for (int s = 0; s < count; ++s)
      {
        FOR_VECTORS(x, spans[s].begin, spans[s].end)
        {
          const real crossing = of_row + (axis == 0 ? (real)along_x[y] : load_real(x, along_x));
          const real power =
            power_of_faces(&layout, &arrays, axis, spans[s].before + x, here + x, load_real(x, passes), crossing);
          store_real(in_row(power, spans[s].end - x), x, out);
        }
      }
    }
    FILL_GHOSTS(powers_x + row, n);
  }
}

// Computes the right-hand side of the diffusion system, numerics.md, Eq. (53): W, in the row layout of MultigridLevel,
// without the power through the box's faces.
//   given    emission and first-collision source, W / (length^3 sr)
//   powers_  results of diffusion_face_powers
__kernel void diffusion_balance(DiffusionLayout layout, const __global float* given, const __global float* powers_x,
  const __global float* powers_y, const __global float* powers_z, __global float* right)
{
  given += layout.first;
  const float per_radiance = 4.0f * M_PI_F * volume_of(&layout);
  const int n = layout.size[0];
  FOR_ROWS(layout.rows)
  {
    const int y = r % layout.size[1], z = r / layout.size[1], row = row_at(&layout.rows, y, z);
    const int high_y = row_at(&layout.rows, y < layout.size[1] - 1 ? y + 1 : 0, z);
    const int high_z = row_at(&layout.rows, y, z < layout.size[2] - 1 ? z + 1 : 0);
    FOR_VECTORS(x, 0, n)
    {
      const real along_x = load_real(row + x, powers_x) - load_real(row + x + 1, powers_x);
      const real along_y = load_real(row + x, powers_y) - load_real(high_y + x, powers_y);
      const real along_z = load_real(row + x, powers_z) - load_real(high_z + x, powers_z);
      const real shines = load_real(r * n + x, given) * per_radiance;
      store_real(in_row(shines + ((along_x + along_y) + along_z), n - x), row + x, right);
    }
  }
}

// Computes the absorbed power of a fluence, W, in the voxels that this rank owns.
//   sums  partial sums of the absorbed power, W, [work-group]
__kernel void diffusion_absorbed(
  DiffusionLayout layout, const __global float* sigma_a, const __global exact* fluence, __global exact* sums)
{
  sigma_a += layout.first;
  exact sum = 0;
  FOR_ROWS(layout.rows)
  {
    const int here = voxel_at(&layout, ROW_Y(layout.rows, r), ROW_Z(layout.rows, r));
    FOR_VOXELS(x, layout.rows.first[0], layout.rows.end[0])
    {
      sum += sigma_a[here + x] * fluence[here + x];
    }
  }
  sum *= volume_of(&layout);
  PUT_SUM_OF_GROUP(exact, sum, sums[get_group_id(0)])
}
