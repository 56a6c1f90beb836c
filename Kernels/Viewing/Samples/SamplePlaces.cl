// Memory layout of samples: in the order of voxels with a border of one voxel, or in bricks (SampleBricks.h).

#pragma once
#include "Viewing/Samples/SampleBricksShared.h"

#if BRICKED
#define SAMPLE_ROWS (GREY ? BrickEdge : SampleEdge) // with GREY a sample holds that of the next row as well
#define ROW_LENGTH(size) SampleEdge
#define SLICE_LENGTH(size) (SampleEdge * SAMPLE_ROWS)
#else
#define ROW_LENGTH(size) ((size).x + 2)
#define SLICE_LENGTH(size) (((size).x + 2) * ((size).y + 2))
#endif
