// Counter-based random numbers: Philox 4x32 with ten rounds (Salmon, Moraes, Dror and Shaw 2011, "Parallel random
// numbers: as easy as 1, 2, 3", section 3.2). A block of four random numbers depends on key and counter only, not on
// the order of evaluation.

#pragma once

static uint4 philox(uint4 counter, uint2 key)
{
  for (int i = 0; i < 10; ++i)
  {
    const uint high0 = mul_hi(0xD2511F53u, counter.x), low0 = 0xD2511F53u * counter.x;
    const uint high1 = mul_hi(0xCD9E8D57u, counter.z), low1 = 0xCD9E8D57u * counter.z;
    counter = (uint4)(high1 ^ counter.y ^ key.x, low1, high0 ^ counter.w ^ key.y, low0);
    key += (uint2)(0x9E3779B9u, 0xBB67AE85u);
  }
  return counter;
}

// State of the sequence of random numbers of one photon.
typedef struct
{
  uint2 key;      // seed of all sequences
  ulong stream;   // index of the photon, which selects its sequence
  uint block;     // index of the next block of the sequence
  int left;       // number of unused values of the current block
  uint values[4]; // values of the current block
} random_numbers;

static random_numbers random_of(ulong seed, ulong stream)
{
  random_numbers random = { (uint2)((uint)seed, (uint)(seed >> 32)), stream, 0, 0, { 0, 0, 0, 0 } };
  return random;
}

// State of the random numbers of a photon that has drawn `blocks` blocks of four numbers, with `left` numbers of the
// last block unused.
static random_numbers random_after(ulong seed, ulong stream, uint blocks, int left)
{
  random_numbers random = random_of(seed, stream);
  random.block = blocks;
  random.left = left;
  if (left > 0)
  {
    vstore4(philox((uint4)((uint)stream, (uint)(stream >> 32), blocks - 1, 0), random.key), 0, random.values);
  }
  return random;
}

// Draws the next random number of a sequence, in (0, 1): (k + 1/2) 2^-24 with an integer k below 2^24.
static float draw(random_numbers* random)
{
  if (random->left == 0)
  {
    const uint4 values =
      philox((uint4)((uint)random->stream, (uint)(random->stream >> 32), random->block++, 0), random->key);
    vstore4(values, 0, random->values);
    random->left = 4;
  }
  return (random->values[--random->left] >> 8) * 0x1p-24f + 0x1p-25f;
}
