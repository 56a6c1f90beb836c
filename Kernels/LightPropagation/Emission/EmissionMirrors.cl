// Kernels of EmissionMirrors: find mirror symmetries of a scene, and copy light to mirror images. `mirrored` is a bit
// mask of the axes across which the scene is symmetric.

#include "LightPropagation/Emission/EmissionRaysShared.h"

// Whether position `at` along an axis is the mirror image of a lower position.
static bool is_image(const EmissionInfo* s, int mirrored, int axis, int at)
{
  return (mirrored >> axis & 1) != 0 && 2 * at >= s->size[axis] + (s->size[axis] & 1);
}

// Position along an axis whose light is copied to position `at`: its mirror image on the low side, or `at` itself.
static int imaged(const EmissionInfo* s, int mirrored, int axis, int at)
{
  return is_image(s, mirrored, axis, at) ? s->size[axis] - 1 - at : at;
}

// Finds axes across which extinction is not symmetric. One work-item per row of voxels.
// differs  [axis], set to 1 if the extinction of any voxel differs from that of its mirror image
__kernel void find_mirrors(
  EmissionInfo s, int mirrored, const __global float* sigma, ulong sigma_first, __global float* differs)
{
  const int y = get_global_id(0), z = get_global_id(1);
  const ulong here = sigma_first + ((ulong)z * s.size[1] + y) * s.size[0];
  const int at[3] = { 0, y, z };
  for (int axis = 0; axis < 3; ++axis)
  {
    if ((mirrored >> axis & 1) == 0 || is_image(&s, mirrored, axis, at[axis]))
    {
      continue;
    }
    const int ys = axis == 1 ? s.size[1] - 1 - y : y, zs = axis == 2 ? s.size[2] - 1 - z : z;
    const ulong there = sigma_first + ((ulong)zs * s.size[1] + ys) * s.size[0];
    bool same = true;
    for (int x = 0; x < s.size[0]; ++x)
    {
      same = same && sigma[here + x] == sigma[there + (axis == 0 ? s.size[0] - 1 - x : x)];
    }
    if (!same)
    {
      differs[axis] = 1.0f;
    }
  }
}

__kernel void mark_images(EmissionInfo s, int mirrored, __global float* found)
{
  bool image = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    image = image || is_image(&s, mirrored, axis, get_global_id(axis));
  }
  if (image)
  {
    found[((ulong)get_global_id(2) * s.size[1] + get_global_id(1)) * s.size[0] + get_global_id(0)] = 1.0f;
  }
}

// Sets `found` to 1 in the cells of a face that are mirror images.
// first  index of the face's first cell in `found`
__kernel void mark_image_cells(EmissionInfo s, int mirrored, int face, ulong first, __global float* found)
{
  const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool image = (mirrored >> axis & 1) != 0 && (face & 1) != 0;
  if (image || is_image(&s, mirrored, u, get_global_id(0)) || is_image(&s, mirrored, v, get_global_id(1)))
  {
    found[first + (ulong)get_global_id(1) * s.size[u] + get_global_id(0)] = 1.0f;
  }
}

// Copies light to the voxels that are mirror images. One work-item per voxel.
// path  path integrals, [channel][voxel]
// flux  net flux, [channel][x, y, z][voxel]; not used if has_flux is 0
__kernel void copy_images(
  EmissionInfo s, int mirrored, int channels, ulong stride, __global float* path, __global float* flux, int has_flux)
{
  int from[3];
  float sign[3];
  bool image = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int at = get_global_id(axis);
    from[axis] = imaged(&s, mirrored, axis, at);
    sign[axis] = from[axis] != at ? -1.0f : 1.0f;
    image = image || from[axis] != at;
  }
  const ulong here = ((ulong)get_global_id(2) * s.size[1] + get_global_id(1)) * s.size[0] + get_global_id(0);
  const ulong there = ((ulong)from[2] * s.size[1] + from[1]) * s.size[0] + from[0];
  for (int c = 0; c < channels && image; ++c)
  {
    path[c * stride + here] = path[c * stride + there];
    for (int a = 0; a < 3 && has_flux; ++a)
    {
      flux[(3 * c + a) * stride + here] = sign[a] * flux[(3 * c + a) * stride + there];
    }
  }
}

// Copies light to the cells of a face that are mirror images.
// faces       [cell][channel]
// from_first  first cell that is read: of the opposite face if this face is its mirror image, else of this face
// first       first cell of this face, which is written
__kernel void copy_image_cells(
  EmissionInfo s, int mirrored, int face, ulong from_first, ulong first, int channels, __global float* faces)
{
  const int u = (face / 2 + 1) % 3, v = (face / 2 + 2) % 3;
  const int at[2] = { get_global_id(0), get_global_id(1) };
  const int from[2] = { imaged(&s, mirrored, u, at[0]), imaged(&s, mirrored, v, at[1]) };
  const ulong to = first + (ulong)at[1] * s.size[u] + at[0];
  const ulong of = from_first + (ulong)from[1] * s.size[u] + from[0];
  for (int c = 0; c < channels && to != of; ++c)
  {
    faces[to * channels + c] = faces[of * channels + c];
  }
}
