// Kernels of the diffusion system of one channel (DiffusionSystem.h): its equations at the box's faces, and quantities
// derived from its solution. Kernels that process all voxels in every iteration are in DiffusionRows.cl. Options:
//   DOUBLES  1: the device has double precision
//
// Faces d of a voxel are -x, +x, -y, +y, -z, +z. tau is the optical length of a voxel along an axis.

#include "LightPropagation/Diffusion/BoxBorders.cl"
#include "LightPropagation/Sweep/MomentPlacesShared.h"

// Conductance of face d of the voxel with indices `at`. The array `conductance` holds one value per voxel and axis,
// that of the voxel's low face, with rows laid out as in MultigridLevel.
static float conductance_at(const DiffusionLayout* layout, const __global float* conductance, int d, const int* at)
{
  int of[3] = { at[0], at[1], at[2] };
  if (d & 1)
  {
    of[d / 2] = at[d / 2] + 1 < layout->size[d / 2] ? at[d / 2] + 1 : 0;
  }
  const MultigridLevel* rows = &layout->rows;
  return conductance[d / 2 * rows->floats + RowsLead + of[2] * rows->plane + of[1] * rows->pitch + of[0]];
}

// Adds, to the loss term of the matrix, the power per fluence that leaves through the box's faces. One work-item per
// cell of the box's faces.
__kernel void diffusion_border_loss(
  DiffusionLayout layout, const __global float* sigma_t, const __global float* sigma_a, __global float* loss)
{
  BORDER_VOXEL(layout)
  const int at[3] = { x, y, z };
  const float s = sigma_t[layout.firstT + i], a = sigma_a[layout.first + i];
  float taken = 0.0f;
  for (int d = 0; d < 6; ++d)
  {
    if (is_border(&layout, at, d))
    {
      const float passes = pass_boundary(&layout, way_to_boundary(&layout, s * layout.spacing[d / 2], s, a));
      const float leaves = face_area(&layout, d / 2) * passes;
      taken += layout.faces ? reflecting_face(&layout, d, passes).ofMedium * leaves : leaves;
    }
  }
  loss[RowsLead + z * layout.rows.plane + y * layout.rows.pitch + x] += taken;
}

// Degree to which a voxel is the skin, i.e. the surface layer, of a thick region (numerics.md, section 7.5), 0 to 1:
// the largest contrast() of its inner faces, 0 if that is below 0.01. Nonzero only next to thinner voxels. `open`
// receives the contrast of each face.
static float openness(
  const DiffusionLayout* layout, const __global float* sigma_t, int i, const int* next, const int* at, float* open)
{
  float most = 0.0f;
  for (int d = 0; d < 6; ++d)
  {
    const int axis = d / 2;
    const float tau = sigma_t[i] * layout->spacing[axis];
    const float beyond = sigma_t[next[d]] * layout->spacing[axis];
    const bool inner = layout->linear && layout->size[axis] > 1 && !is_border(layout, at, d);
    open[d] = inner ? contrast(tau, beyond) : 0.0f;
    most = fmax(most, open[d]);
  }
  return most > 0.01f ? most : 0.0f;
}

typedef struct
{
  const __global float* sigma_t;
  const __global float* sigma_a;
  const __global float* flatSource;
  const __global float* conductance;
  const __global float* currents;
  const __global float* passed;
  const __global float* model;
  const __global float* pattern;
  // Net flux of the known source (emission and first collisions) divided by 4 pi, [axis][voxel].
  const __global float* givenFlux;
  ulong stride;
  // Power by cell of the box's faces, W, [FaceCame ... FaceLeaves][cell]; not used if DiffusionLayout::faces is 0
  const __global float* faces;
} diffusion_arrays;

// Index of a cell of the box's faces (Medium/BoxFaces.h): the cell on face d at the voxel with indices `at`.
static int cell_of_face(const DiffusionLayout* layout, const int* at, int d)
{
  const int* n = layout->size;
  const int cells[3] = { n[1] * n[2], n[0] * n[2], n[0] * n[1] };
  const int axis = d / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  int first = d & 1 ? cells[axis] : 0;
  for (int before = 0; before < axis; ++before)
  {
    first += 2 * cells[before];
  }
  return first + at[v] * n[u] + at[u];
}

static int face_cells(const DiffusionLayout* layout)
{
  const int* n = layout->size;
  return 2 * (n[1] * n[2] + n[0] * n[2] + n[0] * n[1]);
}

// Incident power per area through a cell of face d of the box, W / length^2: boundary source and, if
// DiffusionLayout::faces is 1, the reflected power in the given row of arrays->faces (FaceCame or FaceGiven).
static float coming_in(const DiffusionLayout* layout, const diffusion_arrays* arrays, int row, int d, const int* at)
{
  if (!layout->faces)
  {
    return layout->incoming[d];
  }
  const int cell = cell_of_face(layout, at, d);
  return layout->incoming[d] + arrays->faces[row * face_cells(layout) + cell] / face_area(layout, d / 2);
}

// Fluence difference over half a voxel along an axis that is equivalent to the net flux of the known source (emission
// and first collisions; numerics.md, Eq. (53a)).
static float drive(const DiffusionLayout* layout, const diffusion_arrays* arrays, int axis, int i)
{
  return layout->moments ? 1.5f * layout->spacing[axis] * (4.0f * M_PI_F) * arrays->givenFlux[axis * arrays->stride + i]
                         : 0.0f;
}

// Fluence difference that is equivalent to the net flux of the known source (emission and first collisions), as for
// drive(), but between the centres of voxel i and of voxel j, its neighbour through face d. For drive_out() it is
// between the centre and the box's face d.
static float drive_through(const DiffusionLayout* layout, const diffusion_arrays* arrays, int d, int i, int j)
{
  return (d & 1 ? 1.0f : -1.0f) * (drive(layout, arrays, d / 2, i) + drive(layout, arrays, d / 2, j));
}
static float drive_out(const DiffusionLayout* layout, const diffusion_arrays* arrays, int d, int i)
{
  return (d & 1 ? 1.0f : -1.0f) * drive(layout, arrays, d / 2, i);
}

// Crossing pattern of a voxel's faces perpendicular to an axis: power of the rays that cross them, relative to the mean
// over the grid (SweepModel.h).
static float crossing_at(const DiffusionLayout* layout, const diffusion_arrays* arrays, int axis, const int* at)
{
  const int b = axis == 0 ? 1 : 0;
  const int c = axis == 2 ? 1 : 2;
  return arrays->pattern[layout->pattern[2 * axis] + at[b]] + arrays->pattern[layout->pattern[2 * axis + 1] + at[c]];
}

// Transport correction of the power through inner face d from voxel i to j, W: power of the sweep minus that of
// diffusion, weighted as in remainder_of() (remainder R of numerics.md, Eq. (54)).
static float remainder_of_face(
  const DiffusionLayout* layout, const diffusion_arrays* arrays, int d, int i, int j, const int* at)
{
  const int axis = d / 2;
  const ulong stride = arrays->stride;
  const float passes = conductance_at(layout, arrays->conductance, d, at);
  const inner_face face = { { arrays->sigma_t[i], arrays->sigma_t[j] }, { arrays->sigma_a[i], arrays->sigma_a[j] },
    { arrays->flatSource[axis * layout->flatStride + i], arrays->flatSource[axis * layout->flatStride + j] },
    { arrays->model[i], arrays->model[j] }, passes,
    arrays->currents[(d ^ 1) * stride + j] - arrays->currents[d * stride + i],
    passes * drive_through(layout, arrays, d, i, j), crossing_at(layout, arrays, axis, at) };
  return remainder_of(layout, axis, &face);
}

// Net power that leaves through face d of the box in a sweep if the voxel's fluence is arrays->model (M_d of
// numerics.md, Eq. (59)). `dark` receives the net power by diffusion if the voxel's fluence is 0.
static float model_of_boundary(
  const DiffusionLayout* layout, const diffusion_arrays* arrays, int d, int i, const int* at, float* dark)
{
  const int axis = d / 2;
  const float a = layout->halfRange;
  const float tau = arrays->sigma_t[i] * layout->spacing[axis];
  const float way = way_to_boundary(layout, tau, arrays->sigma_t[i], arrays->sigma_a[i]);
  const float passes = pass_boundary(layout, way);
  const float incoming = coming_in(layout, arrays, FaceCame, d, at);
  const float area = face_area(layout, axis);
  const float driven = drive_out(layout, arrays, d, i);
  const float light = arrays->model[i] + driven;
  if (layout->faces)
  {
    const face_factors factors = reflecting_face(layout, d, passes);
    *dark = area * (factors.ofMedium * passes * driven - factors.ofLight * coming_in(layout, arrays, FaceGiven, d, at));
  }
  else
  {
    *dark = -passes / a * incoming * area;
    *dark += layout->moments ? passes * driven * area : 0.0f;
  }
  const float net = passes * (light - incoming / a);
  if (!layout->linear)
  {
    return net * area;
  }
  const float at_face = light - 1.5f * way * net;
  const float spread = a * at_face + 3.0f * net * arrays->flatSource[axis * layout->flatStride + i] - incoming;
  return pattern_of(crossing_at(layout, arrays, axis, at), tau) * spread * area;
}

// Net power of lamps' first-scattered light that crosses face d of voxel i without another collision, W: outgoing minus
// incoming (Q_d of numerics.md, Eq. (53)).
static float passing(
  const DiffusionLayout* layout, const diffusion_arrays* arrays, int d, int i, const int* next, bool border)
{
  if (!layout->passing)
  {
    return 0.0f;
  }
  return arrays->passed[d * arrays->stride + i] - (border ? 0.0f : arrays->passed[(d ^ 1) * arrays->stride + next[d]]);
}

// Fraction of the medium's outgoing power through face d of the box that escapes after reflection.
static float part_that_leaves(const DiffusionLayout* layout, const diffusion_arrays* arrays, int d, int i)
{
  if (!layout->faces)
  {
    return 1.0f;
  }
  const float tau = arrays->sigma_t[i] * layout->spacing[d / 2];
  const float way = way_to_boundary(layout, tau, arrays->sigma_t[i], arrays->sigma_a[i]);
  return reflecting_face(layout, d, pass_boundary(layout, way)).ofMedium;
}

// Transport correction of the net outgoing power through all faces of the box at voxel i, W: power of the sweep minus
// that of diffusion, times weight_of_transport() (remainder R_box of numerics.md, Eq. (60)).
//   power    emitted and scattered power of the voxel in the sweep, minus the power that collides in it, W
//   share    [face] part of the correction for each face, in proportion to `seeming`
//   seeming  [face] outgoing power of the sweep; estimated, since its tally is not by voxel (numerics.md, Eq. (61))
//   transport_weight  receives the weight of the correction, Eq. (55)
static float remainder_of_borders(const DiffusionLayout* layout, const diffusion_arrays* arrays, int i, const int* next,
  const int* at, float power, float* share, float* seeming, float* transport_weight)
{
  float left = power; // becomes the net outgoing power through the box's faces
  float in = 0.0f, expected = 0.0f, longest = 0.0f, sum = 0.0f, borders = 0.0f;
  float model[6];
  for (int d = 0; d < 6; ++d)
  {
    const int axis = d / 2;
    const float entered = arrays->currents[d * arrays->stride + i];
    model[d] = share[d] = seeming[d] = 0.0f;
    if (is_border(layout, at, d))
    {
      float dark;
      model[d] = model_of_boundary(layout, arrays, d, i, at, &dark);
      const float tau = arrays->sigma_t[i] * layout->spacing[axis];
      const float through = exp(-fmin(tau, 80.0f));
      seeming[d] = through * arrays->currents[(d ^ 1) * arrays->stride + i] +
        (1.0f - through) * layout->halfRange * face_area(layout, axis) * fmax(arrays->model[i], 0.0f);
      if (layout->faces)
      {
        seeming[d] = arrays->faces[FaceLeft * face_cells(layout) + cell_of_face(layout, at, d)];
      }
      expected += model[d];
      sum += seeming[d];
      in += entered;
      longest = fmax(longest, layout->spacing[axis]);
      borders += 1.0f;
    }
    else if (layout->size[axis] > 1)
    {
      left -= arrays->currents[(d ^ 1) * arrays->stride + next[d]] - entered;
    }
  }
  *transport_weight = weight_of_transport(layout, longest * arrays->sigma_t[i], longest * arrays->sigma_a[i]);
  *transport_weight = *transport_weight > 1e-12f ? *transport_weight : 0.0f;
  // In an optically thick voxel the net power may be a difference of large powers that is below their rounding error.
  // Then the sum of the estimates is used instead.
  const float rounding = 1e-6f * arrays->sigma_t[i] * volume_of(layout) * fmax(arrays->model[i], 0.0f);
  const float whole = rounding < 0.01f * sum || sum <= 0.0f ? left + in : sum;
  for (int d = 0; d < 6; ++d)
  {
    // If all estimates are 0, the power is divided equally among the voxel's faces on the box.
    const float part = sum > 0.0f ? seeming[d] / sum : is_border(layout, at, d) ? 1.0f / borders : 0.0f;
    seeming[d] = whole * part;
    const float net = seeming[d] - arrays->currents[d * arrays->stride + i] - model[d];
    share[d] = *transport_weight > 0.0f && is_border(layout, at, d) ? *transport_weight * net : 0.0f;
  }
  if (!layout->faces)
  {
    return *transport_weight > 0.0f ? *transport_weight * (left - expected) : 0.0f;
  }
  float remainder = 0.0f;
  for (int d = 0; d < 6; ++d)
  {
    remainder += is_border(layout, at, d) ? part_that_leaves(layout, arrays, d, i) * share[d] : 0.0f;
  }
  return remainder;
}

// Power, W, that would reach face d of the box from inside if no light were incident, before reflection, by the
// solution of the diffusion system (m of numerics.md, Eq. (76b)). `share` is the face's part of remainder_of_borders().
static exact sent_by_medium(const DiffusionLayout* layout, const diffusion_arrays* arrays, exact fluence, int d, int i,
  const int* next, float passes, float share)
{
  const exact light = fluence + drive_out(layout, arrays, d, i);
  return passes * face_area(layout, d / 2) * light + share + passing(layout, arrays, d, i, next, true);
}

// Net outgoing power through face d of the box by the solution of the diffusion system, W. `share` is the face's part
// of remainder_of_borders().
static exact power_of_border(const DiffusionLayout* layout, const diffusion_arrays* arrays, exact fluence, int d, int i,
  const int* next, const int* at, float share)
{
  const int axis = d / 2;
  const float tau = arrays->sigma_t[i] * layout->spacing[axis];
  const float passes = pass_boundary(layout, way_to_boundary(layout, tau, arrays->sigma_t[i], arrays->sigma_a[i]));
  if (!layout->faces)
  {
    const exact light = fluence + drive_out(layout, arrays, d, i);
    return passes * face_area(layout, axis) * (light - layout->incoming[d] / layout->halfRange) + share +
      passing(layout, arrays, d, i, next, true);
  }
  const float area = face_area(layout, axis);
  const face_factors factors = reflecting_face(layout, d, passes);
  const exact ofMedium = sent_by_medium(layout, arrays, fluence, d, i, next, passes, share);
  return factors.ofMedium * ofMedium - factors.ofLight * area * coming_in(layout, arrays, FaceGiven, d, at);
}

// Net outgoing power through face d of voxel i by the solution of the diffusion system, W. `share` has the parts of
// remainder_of_borders() by face, used only if face d lies on the box's boundary.
static exact power_of_face(const DiffusionLayout* layout, const diffusion_arrays* arrays, const __global exact* fluence,
  int d, int i, const int* next, const int* at, const float* share)
{
  if (is_border(layout, at, d))
  {
    return power_of_border(layout, arrays, fluence[i], d, i, next, at, share[d]);
  }
  if (layout->size[d / 2] == 1)
  {
    return 0;
  }
  const exact passes = conductance_at(layout, arrays->conductance, d, at);
  return passes * (fluence[i] - fluence[next[d]] + drive_through(layout, arrays, d, i, next[d])) +
    remainder_of_face(layout, arrays, d, i, next[d], at) + passing(layout, arrays, d, i, next, false);
}

// Outgoing power through face d of the box by the solution of the diffusion system, W: all power that reaches the face
// from inside, including light that the face reflected earlier (J_out of numerics.md, Eq. (76c)).
static exact power_leaving(const DiffusionLayout* layout, const diffusion_arrays* arrays, exact fluence, int d, int i,
  const int* next, const int* at, float share)
{
  const float tau = arrays->sigma_t[i] * layout->spacing[d / 2];
  const float passes = pass_boundary(layout, way_to_boundary(layout, tau, arrays->sigma_t[i], arrays->sigma_a[i]));
  const exact ofMedium = sent_by_medium(layout, arrays, fluence, d, i, next, passes, share);
  const exact albedo = layout->albedo[d], passes_in = passes / layout->halfRange;
  const exact given = face_area(layout, d / 2) * coming_in(layout, arrays, FaceGiven, d, at);
  return (ofMedium + given * (1 - passes_in)) / (1 - albedo * (1 - passes_in));
}

#define ARRAYS_OF_CHANNEL                                                                                         \
  sigma_t += layout.firstT;                                                                                       \
  sigma_a += layout.first;                                                                                        \
  swept += layout.firstT;                                                                                         \
  currents += 6 * (ulong)layout.first;                                                                            \
  passed += layout.passing ? 6 * (ulong)layout.first : 0;                                                         \
  given_flux += layout.moments ? 3 * (ulong)layout.first : 0;                                                     \
  source += layout.first;                                                                                         \
  path += layout.first;                                                                                           \
  const ulong stride = layout.stride;                                                                             \
  const diffusion_arrays arrays = { sigma_t, sigma_a, flat_source, conductance, currents, passed, model, pattern, \
    given_flux, stride, faces };                                                                                  \
  const int at[3] = { x, y, z };                                                                                  \
  int next[6];                                                                                                    \
  find_neighbours(layout.size, x, y, z, i, next);                                                                 \
  const float per_radiance = 4.0f * M_PI_F * volume_of(&layout);                                                  \
  float share[6], seeming[6], transport_weight;

// Adds the power through the box's faces to `right`, the right-hand side of numerics.md, Eq. (53), W, in the row layout
// of MultigridLevel. One work-item per cell of the box's faces.
//   borders     [cell of the box's faces][BorderNet ... BorderWholeShare]; all but BorderNet are written
//   source      source of the sweep, W / (length^3 sr)
//   given_flux  net flux of the known source divided by 4 pi, if there are angular moments, [channel][x, y, z][voxel]
__kernel void diffusion_border_balance(DiffusionLayout layout, const __global float* sigma_t,
  const __global float* sigma_a, const __global float* swept, const __global float* flat_source,
  const __global float* conductance, const __global float* currents, const __global float* passed,
  const __global float* model, const __global float* pattern, const __global float* source, const __global float* path,
  const __global float* given_flux, const __global float* faces, __global float* right, __global exact* borders)
{
  BORDER_VOXEL(layout)
  ARRAYS_OF_CHANNEL
  float power = 0.0f;
  for (int d = 0; d < 6; ++d)
  {
    if (is_border(&layout, at, d))
    {
      float dark;
      model_of_boundary(&layout, &arrays, d, i, at, &dark);
      power -= dark + part_that_leaves(&layout, &arrays, d, i) * passing(&layout, &arrays, d, i, next, true);
    }
  }
  power -= remainder_of_borders(
    &layout, &arrays, i, next, at, source[i] * per_radiance - swept[i] * path[i], share, seeming, &transport_weight);
  right[RowsLead + z * layout.rows.plane + y * layout.rows.pitch + x] += power;
  int count = 0;
  for (int d = 0; d < 6; ++d)
  {
    count += is_border(&layout, at, d);
  }
  for (int d = 0; d < 6; ++d)
  {
    if (is_border(&layout, at, d))
    {
      __global exact* face = borders + BorderValues * cell_of_face(&layout, at, d);
      face[BorderSeeming] = seeming[d];
      face[BorderWeight] = count > 1 ? transport_weight : -1.0f;
      face[BorderCame] = currents[d * stride + i];
      face[BorderShare] = part_that_leaves(&layout, &arrays, d, i) * share[d];
      face[BorderWholeShare] = share[d];
    }
  }
}

// Computes the power through the box's faces by the solution of the diffusion system, W, for each cell: writes the
// value BorderNet of `borders`, [cell][BorderNet ... BorderWholeShare], and, if DiffusionLayout::faces is 1, the row
// FaceLeaves of `faces`.
__kernel void diffusion_outflow(DiffusionLayout layout, const __global float* sigma_t, const __global float* sigma_a,
  const __global float* passed, const __global float* given_flux, __global float* faces, const __global exact* fluence,
  __global exact* borders)
{
  BORDER_VOXEL(layout)
  const diffusion_arrays arrays = { .sigma_t = sigma_t + layout.firstT,
    .sigma_a = sigma_a + layout.first,
    .passed = passed + (layout.passing ? 6 * (ulong)layout.first : 0),
    .givenFlux = given_flux + (layout.moments ? 3 * (ulong)layout.first : 0),
    .stride = layout.stride,
    .faces = faces };
  const int at[3] = { x, y, z };
  int next[6];
  find_neighbours(layout.size, x, y, z, i, next);
  for (int d = 0; d < 6; ++d)
  {
    if (is_border(&layout, at, d))
    {
      __global exact* face = borders + BorderValues * cell_of_face(&layout, at, d);
      face[BorderNet] = power_of_border(&layout, &arrays, fluence[i], d, i, next, at, 0.0f);
      if (layout.faces)
      {
        faces[FaceLeaves * face_cells(&layout) + cell_of_face(&layout, at, d)] =
          (float)power_leaving(&layout, &arrays, fluence[i], d, i, next, at, (float)face[BorderWholeShare]);
      }
    }
  }
}

// Adds the net flux of the solution, W / length^2, times the voxel's volume to `flux`, [x, y, z][voxel] (numerics.md,
// Eq. (75)).
__kernel void diffusion_flux(DiffusionLayout layout, const __global float* sigma_t, const __global float* sigma_a,
  const __global float* swept, const __global float* flat_source, const __global float* conductance,
  const __global float* currents, const __global float* passed, const __global float* model,
  const __global float* pattern, const __global float* source, const __global float* path,
  const __global float* given_flux, const __global float* faces, const __global exact* fluence, __global float* flux)
{
  VOXEL(layout.size)
  ARRAYS_OF_CHANNEL
  flux += 3 * (ulong)layout.first;
  if (IS_OUTERMOST(layout, at))
  {
    remainder_of_borders(
      &layout, &arrays, i, next, at, source[i] * per_radiance - swept[i] * path[i], share, seeming, &transport_weight);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const exact up = power_of_face(&layout, &arrays, fluence, 2 * axis + 1, i, next, at, share);
    const exact down = power_of_face(&layout, &arrays, fluence, 2 * axis, i, next, at, share);
    flux[axis * stride + i] += (float)(0.5f * (up - down) * layout.spacing[axis]);
  }
}

// Computes the moments of degree 1 of the solution and stores them after the fluence, [x, y, z][voxel]: those of the
// sweep, plus the diffusive net flux of the solution minus that of the fluence `model` (numerics.md, Eq. (70a)).
//   moments  angular moments of the sweep's path integrals, W length
//   model    result of diffusion_model
__kernel void diffusion_found_flux(DiffusionLayout layout, const __global float* conductance,
  const __global float* model, const __global float* moments, MomentPlaces places, int channel, __global exact* fluence)
{
  VOXEL(layout.size)
  const int count = layout.size[0] * layout.size[1] * layout.size[2];
  const int at[3] = { x, y, z };
  int next[6];
  find_neighbours(layout.size, x, y, z, i, next);
  const ulong line = (ulong)z * layout.size[1] + y;
  for (int axis = 0; axis < 3; ++axis)
  {
    float sum = 0.0f;
    for (int d = 2 * axis; d < 2 * axis + 2 && layout.size[axis] > 1; ++d)
    {
      const int j = next[d];
      if (!is_border(&layout, at, d))
      {
        const float change = (float)(fluence[i] - fluence[j]) - (model[i] - model[j]);
        sum += (d & 1 ? 1.0f : -1.0f) * conductance_at(&layout, conductance, d, at) * change;
      }
    }
    const int function = axis == 0 ? 3 : axis; // angular functions 1 to 3 are sqrt(3) times the direction's y, z, x
    const exact swept_length = moments[MOMENT_PLACE(places, function, channel, line, x)];
    fluence[(axis + 1) * count + i] =
      (swept_length + 1.73205081f * 0.5f * sum * layout.spacing[axis]) / volume_of(&layout);
  }
}

// Copies the moments of degree 1, which follow the fluence in `fluence`, to the angular moments of path integrals.
__kernel void diffusion_put_flux(
  DiffusionLayout layout, const __global exact* fluence, MomentPlaces places, int channel, __global float* path)
{
  VOXEL(layout.size)
  const int count = layout.size[0] * layout.size[1] * layout.size[2];
  const ulong line = (ulong)z * layout.size[1] + y;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int function = axis == 0 ? 3 : axis;
    path[MOMENT_PLACE(places, function, channel, line, x)] =
      (float)(fluence[(axis + 1) * count + i] * volume_of(&layout));
  }
}

// Changes the next sweep's source in optically thick voxels next to thinner ones. The new source is a weighted mean of
// the given source and of the source with which the voxel's surface emits the outgoing partial current of diffusion.
// The weight of the second one is openness(), 0 to 1 (numerics.md, Eqs. (63), (64)).
//   skins  [z][y], not NoSkin: the row of voxels has voxels in which openness() is above 0 (written by diffusion_skins)
__kernel void diffusion_surface_source(DiffusionLayout layout, const __global exact* fluence,
  const __global float* sigma_t, const __global float* sigma_a, const __global float* swept,
  const __global float* conductance, const __global float* passed, const __global int* skins, __global float* source)
{
  VOXEL(layout.size)
  if (!skins[z * layout.size[1] + y])
  {
    return;
  }
  const ulong stride = layout.stride;
  const int count = layout.size[0] * layout.size[1] * layout.size[2];
  const ulong begin = layout.first;
  sigma_t += layout.firstT;
  sigma_a += layout.first;
  swept += layout.firstT;
  passed += layout.passing ? 6 * (ulong)layout.first : 0;
  const int at[3] = { x, y, z };
  int next[6];
  find_neighbours(layout.size, x, y, z, i, next);
  float open[6];
  const float skin = openness(&layout, sigma_t, i, next, at, open);
  float shining = 0.0f, sum = 0.0f;
  for (int d = 0; d < 6; ++d)
  {
    if (open[d] > 0.0f && skin > 0.0f)
    {
      const int j = next[d];
      const float area = face_area(&layout, d / 2);
      const float beyond = sigma_t[j] * layout.spacing[d / 2];
      float out = conductance_at(&layout, conductance, d, at) * (float)(fluence[i] - fluence[j]) / area;
      out += layout.passing ? (passed[d * stride + i] - passed[(d ^ 1) * stride + j]) / area : 0.0f;
      const float weight = open[d] * area;
      const float there = (float)fluence[j] + 1.5f * out * way_to_boundary(&layout, beyond, sigma_t[j], sigma_a[j]);
      shining += weight * (there + 2.0f * out);
      sum += weight;
    }
  }
  const float there = sum > 0.0f ? fmax(shining / sum, 0.0f) * swept[i] * (0.25f * M_1_PI_F) : 0.0f;
  // If the weight `skin` is 1, the previous source is not read, because it may exceed the range of floats.
  source[begin + i] = skin < 1.0f ? mix(source[begin + i], there, skin) : there;
}
