// Kernels of coarse-mesh DSA (CoarseDiffusion.h): transfer light from voxels to cells, and from cells to voxels.
// Options:
//   REAL_WIDTH  number of floats in a vector, 4 or 8; 1: one cell per work-item, on a GPU
//   GROUP       number of work-items that sum together (GroupSum.cl)
//   DOUBLES     1: the device has double precision

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "LightPropagation/Diffusion/MultigridRows.cl"
#include "Numerics/Exact.cl"

#define CELLS_AT_ONCE 64

// For each coarse cell, sums `scale` * value + `more` over those of its voxels that lie in the block. Work-items
// process rows of cells.
__kernel void sum_cells(
  CoarseCells box, const __global float* values, float scale, float more, __global float* sums, ulong first)
{
  values += first;
  FOR_ROWS(box.cells)
  {
    const int y = r % box.cells.size[1], z = r / box.cells.size[1];
    const int begin_y = max((y << box.halvings[1]) - box.origin[1], 0),
              begin_z = max((z << box.halvings[2]) - box.origin[2], 0);
    const int end_y = min(((y + 1) << box.halvings[1]) - box.origin[1], box.size[1]),
              end_z = min(((z + 1) << box.halvings[2]) - box.origin[2], box.size[2]);
    __global float* row = sums + row_at(&box.cells, y, z);
    FOR_VOXELS(x, 0, box.cells.size[0])
    {
      const int begin_x = max((x << box.halvings[0]) - box.origin[0], 0),
                end_x = min(((x + 1) << box.halvings[0]) - box.origin[0], box.size[0]);
      float sum = 0.0f;
      for (int w = begin_z; w < end_z; ++w)
      {
        for (int v = begin_y; v < end_y; ++v)
        {
          const __global float* voxels = values + ((ulong)w * box.size[1] + v) * box.size[0];
          for (int u = begin_x; u < end_x; ++u)
          {
            sum += voxels[u];
          }
        }
      }
      row[x] = scale * sum + more * (max(end_x - begin_x, 0) * max(end_y - begin_y, 0) * max(end_z - begin_z, 0));
    }
  }
}

// A source that is constant in each voxel causes a larger current than a linear source (numerics.md, Eq. (51)). Returns
// this excess divided by the first term of its expansion in tau (f of Eq. (76g)), accurate to 1e-4 up to tau = 1.5.
inline float part_of_first_term(float tau)
{
  return 1.0f / (1.0f + tau * (0.183f + 0.0163f * tau));
}

// Correction of the scattered power of a voxel for light that varies linearly instead of being constant in each voxel
// (one term of the sum in numerics.md, Eq. (76f)). The neighbour's correction is the negative.
//   own, other        path integrals of the voxel and of its neighbour
//   t, s              sigma_t and sigma_s of the voxel
//   other_t, other_s  sigma_t and sigma_s of the neighbour
//   spacing           distance between their centres
inline float sharpen(float own, float other, float t, float s, float other_t, float other_s, float spacing)
{
  const float both = t + other_t;
  const float scattered = (s * t + other_s * other_t) / fmax(both, 1e-37f);
  return scattered * (own - other) * part_of_first_term(0.5f * spacing * both) / 12.0f;
}

// Correction of the scattered power of a voxel at a face of the box (numerics.md, Eq. (76g)): constant light in a voxel
// emits more through the face than light that decreases towards it. The correction is counted as power that did not
// escape.
inline float sharpen_at_face(float own, float inner, float t, float s, float spacing)
{
  return s * (inner - own) * part_of_first_term(spacing * t) / 24.0f;
}

// A row of the block's voxels along x whose scattered source is computed. The pointers are those of scatter_row, moved
// to the row's first voxel; ghost voxels and neighbouring rows are at other indices of the same arrays.
typedef struct
{
  const __global float *path, *sigma_t, *sigma_s;
  __global float* source;
  float perVolume;
} scattering_row;

// Correction of voxel x of a row for its neighbour at index `other`; `spacing` is the distance between their centres.
inline float sharpen_between(const scattering_row* row, int x, int other, float spacing)
{
  return sharpen(row->path[x], row->path[other], row->sigma_t[x], row->sigma_s[x], row->sigma_t[other],
    row->sigma_s[other], spacing);
}

// Corrects the source of a row for light that varies linearly along x (numerics.md, Eq. (76f)).
//   ghosts  whether there is a ghost voxel before the row, and after it
inline void sharpen_along_row(const CoarseCells* box, const scattering_row* row, const bool* ghosts)
{
  const int n = box->size[0];
  for (int x = 0; x + 1 < n; ++x)
  {
    const float more = row->perVolume * sharpen_between(row, x, x + 1, box->spacing[0]);
    row->source[x] += more;
    row->source[x + 1] -= more;
  }
  if (box->wraps[0])
  {
    const int x = n - 1;
    const float more = row->perVolume * sharpen_between(row, x, 0, box->spacing[0]);
    row->source[x] += more;
    row->source[0] -= more;
  }
  for (int side = 0; side < 2; ++side)
  {
    const int x = side ? n - 1 : 0, other = side ? n : -1;
    if (ghosts[side])
    {
      row->source[x] += row->perVolume * sharpen_between(row, x, other, box->spacing[0]);
    }
  }
}

// Corrects the source of a row for light that varies linearly along y and z (numerics.md, Eq. (76f)).
//   beside  index steps to the neighbouring rows at -y, +y, -z, +z; 0 at a face of the box
inline void sharpen_across_rows(const CoarseCells* box, const scattering_row* row, const int* beside)
{
  for (int k = 0; k < 4; ++k)
  {
    for (int x = 0; x < box->size[0] && beside[k] != 0; ++x)
    {
      row->source[x] += row->perVolume * sharpen_between(row, x, x + beside[k], box->spacing[1 + k / 2]);
    }
  }
}

// Corrects the source of a row at the faces of the box (numerics.md, Eq. (76g)).
//   ghosts, beside  as in sharpen_along_row and sharpen_across_rows
//   kept            sums of sharpen_at_face() at the faces -x to +z, added to
inline void sharpen_at_faces(
  const CoarseCells* box, const scattering_row* row, const bool* ghosts, const int* beside, float* kept)
{
  const __global float *path = row->path, *sigma_t = row->sigma_t, *sigma_s = row->sigma_s;
  const int n = box->size[0];
  for (int side = 0; side < 2 && !box->wraps[0] && box->held[0] > 1; ++side)
  {
    if (ghosts[side])
    {
      continue;
    }
    const int x = side ? n - 1 : 0, inner = side ? n - 2 : 1;
    const float more = row->perVolume * sharpen_at_face(path[x], path[inner], sigma_t[x], sigma_s[x], box->spacing[0]);
    row->source[x] += more;
    kept[side] += more;
  }
  for (int k = 0; k < 4; ++k)
  {
    const int inner = beside[k ^ 1];
    for (int x = 0; x < n && beside[k] == 0 && inner != 0; ++x)
    {
      const float more =
        row->perVolume * sharpen_at_face(path[x], path[x + inner], sigma_t[x], sigma_s[x], box->spacing[1 + k / 2]);
      row->source[x] += more;
      kept[2 + k] += more;
    }
  }
}

// Computes the source scattered from path integrals (numerics.md, Eqs. (76f), (76g)). One work-item per row of the
// block's voxels. `path`, `sigma_t` and `sigma_s` include ghost voxels.
//   path        path integrals, W length; may be negative
//   source      W / (length^3 sr), added to if `adds`
//   per_volume  sign / (4 pi times the volume of a voxel)
//   tally       [row] sums of the source, of its absolute value, and of sharpen_at_face() at each face of the box
__kernel void scatter_row(CoarseCells box, const __global float* restrict path, const __global float* restrict sigma_t,
  const __global float* restrict sigma_s, __global float* restrict source, float per_volume, int adds,
  __global float8* tally)
{
  const int* n = box.size;
  const int r = get_global_id(0), y = r % n[1] + box.lead[1], z = r / n[1] + box.lead[2];
  const int row = box.held[0], plane = box.held[0] * box.held[1], i = z * plane + y * row + box.lead[0];
  path += box.heldFirst + i;
  source += box.first + r * n[0];
  sigma_s += box.heldFirst + i;
  sigma_t += box.heldFirstT + i;
  float sum = 0.0f, magnitude = 0.0f, kept[6] = { 0.0f };
  for (int x = 0; x < n[0]; ++x)
  {
    source[x] = (adds ? source[x] : 0.0f) + per_volume * sigma_s[x] * path[x];
  }
  const bool ghosts[2] = { box.lead[0] > 0, box.held[0] > box.lead[0] + n[0] };
  const int around_y = box.wraps[1] ? plane - row : 0, around_z = box.wraps[2] ? (box.held[2] - 1) * plane : 0;
  const int beside[4] = { y > 0 ? -row : around_y, y < box.held[1] - 1 ? row : -around_y, z > 0 ? -plane : around_z,
    z < box.held[2] - 1 ? plane : -around_z };
  if (box.linear)
  {
    const scattering_row own = { path, sigma_t, sigma_s, source, per_volume };
    sharpen_along_row(&box, &own, ghosts);
    sharpen_across_rows(&box, &own, beside);
    sharpen_at_faces(&box, &own, ghosts, beside, kept);
  }
  for (int x = 0; x < n[0]; ++x)
  {
    sum += source[x];
    magnitude += fabs(source[x]);
  }
  tally[r] = (float8)(sum, magnitude, kept[0], kept[1], kept[2], kept[3], kept[4], kept[5]);
}

// The two cells between whose centres a voxel lies along an axis, and the voxel's distance `way` from the centre of
// cell `from`, in units of a cell's edge. Beyond the last centre `way` is negative, for extrapolation from the last two
// cells.
typedef struct
{
  int from, to;
  float way;
} between;

inline between find_between(const CoarseCells* box, int axis, int voxel)
{
  const int edge = 1 << box->halvings[axis], cells = box->cells.size[axis];
  between found;
  found.from = voxel >> box->halvings[axis];
  found.way = ((voxel & (edge - 1)) + 0.5f) / edge - 0.5f;
  found.to = found.from + (found.way > 0.0f ? 1 : -1);
  found.way = fabs(found.way);
  if (found.to < 0 || found.to >= cells)
  {
    const int inner = cells == 1 ? 0 : found.to < 0 ? 1 : cells - 2, around = found.to < 0 ? cells - 1 : 0;
    found.to = box->periodic[axis] ? around : inner;
    found.way = box->periodic[axis] ? found.way : -found.way;
  }
  return found;
}

// Adds the path integrals of a sweep, and the diffusion solution on the cells interpolated to voxels, to the fluence.
// Sets the path integrals to minus those of the solution: the next sweep also transports the light scattered from the
// solution, and so computes the predicted light once more (numerics.md, Eq. (76e)). One work-item per row of voxels.
//   found    solution, W / length^2, by cell
//   path     path integrals, W length; replaced
//   fluence  W / length^2; the light is added to it
//   tally    [row] power absorbed from all light that is added, and from the solution only
__kernel void add_found(CoarseCells box, const __global exact* found, __global float* restrict path,
  __global float* restrict fluence, const __global float* restrict sigma_t, const __global float* restrict sigma_s,
  float volume, __global float8* tally)
{
  const int* n = box.size;
  const int r = get_global_id(0);
  path += box.first + r * n[0];
  fluence += box.first + r * n[0];
  sigma_s += box.first + r * n[0];
  sigma_t += box.firstT + r * n[0];
  const between y = find_between(&box, 1, box.origin[1] + r % n[1]),
                z = find_between(&box, 2, box.origin[2] + r / n[1]);
  const int cells = box.cells.size[0], plane = cells * box.cells.size[1];
  const __global exact* low = found + y.from * cells + z.from * plane;
  const int aside = (y.to - y.from) * cells, above = (z.to - z.from) * plane;
  float absorbed = 0.0f, of_found = 0.0f;
  float line[CELLS_AT_ONCE + 2]; // solution by cell along the row of voxels, with one more cell at each end
  for (int first = 0; first < cells; first += CELLS_AT_ONCE)
  {
    const int count = min(CELLS_AT_ONCE, cells - first);
    for (int k = 0; k < count + 2; ++k)
    {
      int x = first + k - 1;
      x = x < 0 ? (box.periodic[0] ? cells - 1 : 0) : x >= cells ? (box.periodic[0] ? 0 : cells - 1) : x;
      const float a = low[x] + y.way * (low[x + aside] - low[x]);
      const float b = low[x + above] + y.way * (low[x + above + aside] - low[x + above]);
      line[k] = a + z.way * (b - a);
    }
    if (!box.periodic[0] && cells > 1)
    {
      line[0] = first == 0 ? 2.0f * line[1] - line[2] : line[0];
      line[count + 1] = first + count == cells ? 2.0f * line[count] - line[count - 1] : line[count + 1];
    }
    const int edge = 1 << box.halvings[0], half_edge = edge >> 1;
    for (int k = 0; k < edge; ++k)
    {
      const float way = (k + 0.5f) / edge - 0.5f;
      const int to = k < half_edge ? 0 : 2;
      for (int c = 0; c < count; ++c)
      {
        const int x = ((first + c) << box.halvings[0]) + k - box.origin[0];
        if ((uint)x < (uint)n[0])
        {
          const float more = line[c + 1] + fabs(way) * (line[c + to] - line[c + 1]);
          const float path_of_found = volume * more;
          const float all = path[x] + path_of_found, sigma_a = fmax(sigma_t[x] - sigma_s[x], 0.0f);
          fluence[x] += all / volume;
          absorbed += sigma_a * all;
          of_found += sigma_a * path_of_found;
          path[x] = -path_of_found;
        }
      }
    }
  }
  tally[r] = (float8)(absorbed, of_found, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f);
}

// Adds the path integrals of a sweep, and of an initial guess of all later orders, to the fluence. Like add_found(),
// but with a guess by voxel instead of the cells' solution.
//   guess  path integrals of all later orders, W length
__kernel void add_guess(CoarseCells box, const __global float* restrict guess, __global float* restrict path,
  __global float* restrict fluence, const __global float* restrict sigma_t, const __global float* restrict sigma_s,
  float volume, __global float8* tally)
{
  const int r = get_global_id(0);
  float absorbed = 0.0f, of_guess = 0.0f;
  for (int x = 0; x < box.size[0]; ++x)
  {
    const int i = box.first + r * box.size[0] + x;
    const float sigma_a = fmax(sigma_t[box.firstT + r * box.size[0] + x] - sigma_s[i], 0.0f);
    const float all = path[i] + guess[i];
    fluence[i] += all / volume;
    absorbed += sigma_a * all;
    of_guess += sigma_a * guess[i];
    path[i] = -guess[i];
  }
  tally[r] = (float8)(absorbed, of_guess, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f);
}
