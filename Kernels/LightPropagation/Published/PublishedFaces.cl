// Light through the cells of the box's faces (numerics.md, section 3): what a direction's rays take out through each
// cell, and what comes in through it beside the boundary's radiance. How cells are numbered: PublishedShared.h.
//   left     W / (length^2 sr) summed over rays, of one direction: [plane][v] through u, [plane][u] through v,
//            [v][u] behind the last plane
//   face_in  radiance that faces give back, of all cells

// What leaves through the sides as a row's rays move into the next voxel; through an edge, half through either side.
static void leave_cells(const PublishedMap* map, const PublishedFaceCells* faces, const PublishedCrossing* crossing,
  int level, __global const float* row, int v, __global float* left)
{
  const int leaves_u = crossing->moveU != 0 && !map->periodicU;
  const int leaves_v = crossing->moveV != 0 && !map->periodicV && v == (crossing->moveV > 0 ? map->sizeV - 1 : 0);
  const int edge = leaves_u ? (crossing->moveU > 0 ? map->sizeU - 1 : 0) : -1;
  if (leaves_u)
  {
    left[level * map->sizeV + v] += leaves_v ? 0.5f * row[edge] : row[edge];
  }
  if (leaves_v)
  {
    left += faces->planes * map->sizeV + level * map->sizeU;
    for (int u = 0; u < map->sizeU; ++u)
    {
      left[u] += u == edge ? 0.5f * row[u] : row[u];
    }
  }
}

static void leave_ahead(
  const PublishedMap* map, const PublishedFaceCells* faces, __global const float* row, int v, __global float* left)
{
  left += faces->planes * (map->sizeV + map->sizeU) + v * map->sizeU;
  for (int u = 0; u < map->sizeU; ++u)
  {
    left[u] += row[u];
  }
}

inline int comes_in(int move, int periodic, int position, int size)
{
  return move != 0 && !periodic && position == (move > 0 ? 0 : size - 1);
}

// What a ray has that comes into voxel (u, v) through a side; through an edge, the mean of both.
//   boundary  radiance entering across w, u, v, CHANNELS apart
static float entering(const PublishedMap* map, const PublishedFaceCells* faces, const PublishedCrossing* crossing,
  int level, int u, int v, __global const float* boundary, __global const float* face_in)
{
  const int through_u = comes_in(crossing->moveU, map->periodicU, u, map->sizeU);
  const int through_v = comes_in(crossing->moveV, map->periodicV, v, map->sizeV);
  float radiance = 0.0f;
  if (through_u)
  {
    const int cell = faces->firstU[crossing->moveU < 0] + level * faces->stepUW + v * faces->stepUV;
    radiance += boundary[CHANNELS] + face_in[cell];
  }
  if (through_v)
  {
    const int cell = faces->firstV[crossing->moveV < 0] + level * faces->stepVW + u * faces->stepVU;
    radiance += boundary[2 * CHANNELS] + face_in[cell];
  }
  return through_u && through_v ? 0.5f * radiance : radiance;
}

// Puts it where the rays of a row are read from as they move on: from[u] goes to voxel u. No other row's rays are.
static void enter_row(const PublishedMap* map, const PublishedFaceCells* faces, const PublishedCrossing* crossing,
  int level, int v, __global const float* boundary, __global const float* face_in, __global float* from)
{
  if (comes_in(crossing->moveV, map->periodicV, v, map->sizeV))
  {
    for (int u = 0; u < map->sizeU; ++u)
    {
      from[u] = entering(map, faces, crossing, level, u, v, boundary, face_in);
    }
  }
  else if (crossing->moveU != 0 && !map->periodicU)
  {
    const int u = crossing->moveU > 0 ? 0 : map->sizeU - 1;
    from[u] = entering(map, faces, crossing, level, u, v, boundary, face_in);
  }
}
