// Kernels that compute a level of a light pyramid from the next finer level, one work-item per row (or cell).

#include "Reconstruction/LightRows.cl"

// Copies voxels of 1 or 3 components from the host's layout, with rows of `pitch` voxels, to the fields of a level (one
// field per component), from field number `first` on.
__kernel void split_voxels(
  const __global float* voxels, int components, int pitch, __global float* level, int4 size, int first)
{
  const int y = ROW_Y, z = ROW_Z;
  const size_t from = ((size_t)z * size.y + y) * pitch, field = field_of(size);
  __global float* row = level + row_of(size, first, y, z);
  FOR_CELLS(x, size.x)
  {
    if (components == 1)
    {
      store_real(load_real(from + x, voxels), x, row);
      repeat_ends(row, x, REAL_WIDTH, size.x);
    }
    else
    {
      const real_of_three vectors = load_reals_of_three(from + x, voxels);
      store_real(vectors.x, x, row);
      store_real(vectors.y, x, row + field);
      store_real(vectors.z, x, row + 2 * field);
      for (int c = 0; c < 3; ++c)
      {
        repeat_ends(row + c * field, x, REAL_WIDTH, size.x);
      }
    }
  }
}

// Filters 4 x 4 x 4 finer cells with a separable kernel. Along each axis the two inner cells have the weight `near`,
// the two outer ones `far`.
__kernel void smooth_down(
  const __global float* fine, int4 fine_size, __global float* coarse, int4 size, int fields, float near, float far)
{
  const float weights[4] = { far, near, near, far };
  const int y = ROW_Y, z = ROW_Z;
  size_t rows[16];
  for (int k = 0; k < 16; ++k)
  {
    rows[k] = row_of(fine_size, 0, 2 * y + k % 4 - 1, 2 * z + k / 4 - 1);
  }
  for (int f = 0; f < fields; ++f)
  {
    const __global float* from = fine + f * field_of(fine_size);
    __global float* row = coarse + row_of(size, f, y, z);
    FOR_CELLS(x, size.x)
    {
      pair left = 0.0f, right = 0.0f;
#pragma unroll
      for (int k = 0; k < 16; ++k)
      {
        const __global float* cells = from + rows[k] + 2 * x;
        const float w = weights[k % 4] * weights[k / 4];
        left += w * load_pair(-1, cells);
        right += w * load_pair(1, cells);
      }
      store_real((real)far * (left.even + right.odd) + (real)near * (left.odd + right.even), x, row);
      repeat_ends(row, x, REAL_WIDTH, size.x);
    }
  }
}

// Computes the sum of 2 x 2 x 2 finer cells or, with `mean`, the mean of those that are not 0 (listing B.2).
__kernel void join_down(
  const __global float* fine, int4 fine_size, __global float* coarse, int4 size, int fields, int mean)
{
  const int y = ROW_Y, z = ROW_Z;
  for (int f = 0; f < fields; ++f)
  {
    __global float* row = coarse + row_of(size, f, y, z);
    FOR_CELLS(x, size.x)
    {
      real sum = 0.0f, lit = 0.0f;
      for (int k = 0; k < 4; ++k)
      {
        const int fy = 2 * y + k % 2, fz = 2 * z + k / 2;
        if (fy < fine_size.y && fz < fine_size.z)
        {
          const pair cells = load_pair(2 * x, fine + row_of(fine_size, f, fy, fz));
          sum += cells.even + cells.odd;
          lit += select((real)0.0f, (real)1.0f, cells.even > 0.0f) + select((real)0.0f, (real)1.0f, cells.odd > 0.0f);
        }
      }
      if (mean)
      {
        sum = select((real)0.0f, sum / lit, lit > 0.0f);
      }
      store_real(sum, x, row);
      if (!mean && x + REAL_WIDTH >= size.x &&
        2 * size.x > fine_size.x) // odd size: the last finer cell, which the padding repeats, must be counted once
      {
        float last = 0.0f;
        for (int k = 0; k < 4; ++k)
        {
          const int fy = 2 * y + k % 2, fz = 2 * z + k / 2;
          if (fy < fine_size.y && fz < fine_size.z)
          {
            last += fine[row_of(fine_size, f, fy, fz) + fine_size.x - 1];
          }
        }
        row[size.x - 1] = last;
      }
      repeat_ends(row, x, REAL_WIDTH, size.x);
    }
  }
}

// Copies rows of `count` voxels. Rows are from_row voxels apart in the source and to_row voxels apart in the copy,
// whose padding repeats the last voxel. The layout changes from [voxel][batch][channel] to [batch][voxel][channel].
// There are 1 or 3 channels; with a loop over them, code that PoCL 7.1 makes writes past the end of the copy.
__kernel void copy_rows(
  const __global float* from, int count, int from_row, __global float* to, int to_row, int batches, int channels)
{
  const size_t row = get_global_id(0), rows = get_global_size(0);
  const __global float* values = from + row * from_row * batches * channels;
  for (int b = 0; b < batches; ++b)
  {
    __global float* out = to + (b * rows + row) * to_row * channels;
    for (int x = 0; x < to_row; ++x)
    {
      const int to_x = x * channels, from_x = (min(x, count - 1) * batches + b) * channels;
      out[to_x] = values[from_x];
      if (channels > 1)
      {
        out[to_x + 1] = values[from_x + 1];
        out[to_x + 2] = values[from_x + 2];
      }
    }
  }
}
