// Memory layout of packed samples: in the order of voxels with a border of one voxel, or in bricks (SampleBricks).

#pragma once
#include "Viewing/Scene/ViewShared.h"

// Number of rows of samples in a slice of a brick; one fewer if samples are grey, since a grey sample also holds its
// neighbour in the next row
#define SAMPLE_ROWS_OF(grey) ((grey) ? BrickEdge : SampleEdge)

#if BRICKED
#define SAMPLE_ROWS SAMPLE_ROWS_OF(GREY)
#define ROW_LENGTH(size) SampleEdge
#define SLICE_LENGTH(size) (SampleEdge * SAMPLE_ROWS)
#else
#define ROW_LENGTH(size) ((size).x + 2)
#define SLICE_LENGTH(size) (((size).x + 2) * ((size).y + 2))
#endif

// Indices of samples. The samples have a border of one voxel that repeats the outermost voxels. padded_index is the
// index of a work-item's sample; voxel_of is the index of the voxel whose values this sample holds.

inline int padded_index(int4 size)
{
  return ((int)get_global_id(2) * (size.y + 2) + (int)get_global_id(1)) * (size.x + 2) + (int)get_global_id(0);
}
// Index of the voxel whose values a sample holds.
// @param sample  indices of the sample along each axis of the grid with its border
inline int voxel_of(int3 sample, int4 size)
{
  const int i = clamp(sample.x - 1, 0, size.x - 1);
  const int j = clamp(sample.y - 1, 0, size.y - 1);
  const int k = clamp(sample.z - 1, 0, size.z - 1);
  return (k * size.y + j) * size.x + i;
}
inline int3 sample_of_item()
{
  return (int3)((int)get_global_id(0), (int)get_global_id(1), (int)get_global_id(2));
}
inline int voxel_index(int4 size)
{
  return voxel_of(sample_of_item(), size);
}
// Whether any ray samples a voxel of this work-group, which packs PackedAlong voxels of a row.
// @param seen  one flag per work-group along x and per 8 x 8 rows, the cross-section of a brick (SeenGroups in
//   PackedSamples.cxx)
inline int is_seen(__global const uchar* seen, int4 size)
{
  const int j = clamp((int)get_global_id(1) - 1, 0, size.y - 1) >> BrickBits;
  const int k = clamp((int)get_global_id(2) - 1, 0, size.z - 1) >> BrickBits;
  const int ny = (size.y + BrickEdge - 1) / BrickEdge;
  return seen[(k * ny + j) * (int)get_num_groups(0) + (int)get_group_id(0)];
}

#if BRICKED
// Index of a work-item's sample among the samples of all records, where a record has the samples of one brick.
// Work-items are numbered x along a row of SampleEdge samples, y over the rows of a slice, z over the slices of all
// records.
inline int place_in_records()
{
  return ((int)get_global_id(2) * SAMPLE_ROWS + (int)get_global_id(1)) * SampleEdge + (int)get_global_id(0);
}
// Finds the indices of a work-item's sample in the grid with its border.
// @param bricks  for each record (the samples of one brick), index of its brick; -1: none
// @return false if the record belongs to no brick; the sample is then zero
inline int find_sample_in_brick(__global const int* bricks, int4 size, int3* sample)
{
  const int record = (int)get_global_id(2) / SampleEdge;
  const int brick = bricks[record];
  const int nx = size.x / BrickEdge + 1, ny = size.y / BrickEdge + 1;
  sample->x = brick % nx * BrickEdge + (int)get_global_id(0);
  sample->y = brick / nx % ny * BrickEdge + (int)get_global_id(1);
  sample->z = brick / (nx * ny) * BrickEdge + (int)get_global_id(2) - record * SampleEdge;
  return brick >= 0;
}
#endif
