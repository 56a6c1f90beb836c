// Gradient noise of Perlin (Improving noise, SIGGRAPH 2002) with a hash in place of his table, so that a seed chooses
// one of 2^32 patterns.

#pragma once

inline uint scrambled(uint bits)
{
  bits ^= bits >> 16;
  bits *= 0x7feb352du;
  bits ^= bits >> 15;
  bits *= 0x846ca68bu;
  bits ^= bits >> 16;
  return bits;
}

// Dot product of `away` with one of the twelve directions to the midpoints of a cube's edges, chosen by a hash.
inline float gradient_at(int3 corner, uint seed, float3 away)
{
  const uint hash = scrambled((uint)corner.x + scrambled((uint)corner.y + scrambled((uint)corner.z + seed)));
  const uint kind = hash % 12;
  const float first = kind < 8 ? away.x : away.y;
  const float second = kind < 4 ? away.y : away.z;
  return ((kind & 1) ? -first : first) + ((kind & 2) ? -second : second);
}

// Gradient noise in [-1, 1], twice continuously differentiable, 0 at integer coordinates; features have a size of about
// 1.
inline float gradient_noise(float3 position, uint seed)
{
  const float3 low = floor(position);
  const int3 corner = convert_int3(low);
  const float3 in = position - low;
  const float3 fade = in * in * in * (in * (in * 6.0f - 15.0f) + 10.0f);
  float value[2];
  for (int z = 0; z < 2; ++z)
  {
    float row[2];
    for (int y = 0; y < 2; ++y)
    {
      const float left = gradient_at(corner + (int3)(0, y, z), seed, in - (float3)(0, y, z));
      const float right = gradient_at(corner + (int3)(1, y, z), seed, in - (float3)(1, y, z));
      row[y] = mix(left, right, fade.x);
    }
    value[z] = mix(row[0], row[1], fade.y);
  }
  return clamp(mix(value[0], value[1], fade.z), -1.0f, 1.0f);
}
