// Functions that carry the rays of a bundle (directions that are mirror images of each other) through a row of voxels,
// with light and source in angular moments (numerics.md, section 4.7). Compiled once for each number of MEMBERS, by
// SweepBundle.cl.
//
// Members (directions) of a frame differ only in the signs of their components along u and v, so the values of an
// angular function in their directions differ only in sign. Sums over functions are therefore formed once per parity
// along u and v. Four such sums, with signs, give the results of up to four members. A bundle has one frame or two;
// each value of a moment is read once for both.

#define MOST_OF_FRAME (MEMBERS < 4 ? MEMBERS : 4)
// Index of the first direction (member) of frame f of a bundle. A frame is a set of members that differ only in signs;
// eight members are two frames of four.
#define BEGIN_OF_FRAME(f) (MEMBERS == 8 ? 4 * (f) : bundle->firstOfFrame[f])

// OF_ALL_PARITIES(MACRO) runs MACRO(parity) for one parity after another, and so covers all angular functions from the
// second on. It skips parities whose functions are zero in all of the bundle's directions. BEGIN_PARITIES loads the
// necessary values into registers.
#define BEGIN_PARITIES                                                  \
  const int functions = state->functions, parities = bundle->parities;  \
  const int end_0 = state->parityEnds[0], end_1 = state->parityEnds[1]; \
  const int end_2 = state->parityEnds[2], end_3 = state->parityEnds[3]; \
  const __global int* const places = state->functionPlaces;
#define FUNCTIONS_OF(MACRO, begin, end, parity) \
  for (int k = begin; k < end; ++k)             \
  {                                             \
    const int place = places[k];                \
    MACRO(parity)                               \
  }
#define OF_ALL_PARITIES(MACRO)           \
  FUNCTIONS_OF(MACRO, 1, end_0, 0)       \
  if (parities & 2)                      \
  {                                      \
    FUNCTIONS_OF(MACRO, end_0, end_1, 1) \
  }                                      \
  if (parities & 4)                      \
  {                                      \
    FUNCTIONS_OF(MACRO, end_1, end_2, 2) \
  }                                      \
  if (parities & 8)                      \
  {                                      \
    FUNCTIONS_OF(MACRO, end_2, end_3, 3) \
  }

// Computes the source of the voxels of row y in each direction (member) of the bundle (numerics.md, Eq. (29b)), and
// stores it as row number `slot` of state->sources. Rows have the layout of the ring buffers of rays; the padding after
// the last row of these buffers precedes the first row of sources.
// @param frames  number of frames (sets of members that differ only in signs) of the bundle, 1 or 2, a compile-time
//   constant
static inline __attribute__((always_inline)) void FIND_SOURCES(sweep_state* state, int y, int slot,
  const __global BundleInfo* bundle, const __global float* coefficients, const int frames)
{
  __global float* out = state->sources + slot * RAYS_OF_ROW;
  const int word = state->words[y];
  BEGIN_PARITIES
  const __global float* of_beams = coefficients + frames * functions;
  for (int c = 0; c < CHANNELS; ++c)
  {
    const __global float* fluence = ROW_OF(state->planes, PlaneSource + c, y);
    const __global float* higher = state->momentSource + y * state->momentStep + c * state->momentChannel;
    const __global float* beams = ROW_OF(state->planes, PLANE_BEAMS + c, y);
    for (int x = 0; x < state->width; x += REAL_WIDTH)
    {
      if (!IS_FILLED(word, x, state->segmentBits))
      {
        continue;
      }
      const int group = IN_ROW(x, functions - 1);
      real sums[MaxFrames][4];
#pragma unroll
      for (int f = 0; f < frames; ++f)
      {
        sums[f][0] = load_real(x, fluence) * (real)coefficients[f * functions];
        sums[f][1] = sums[f][2] = sums[f][3] = (real)0.0f;
      }
#define ADD_FUNCTION(parity)                                                                       \
  const real value = load_real(group, higher + place);                                             \
  _Pragma("unroll") for (int f = 0; f < frames; ++f)                                               \
  {                                                                                                \
    sums[f][parity] = multiply_add(value, (real)coefficients[f * functions + k], sums[f][parity]); \
  }
      OF_ALL_PARITIES(ADD_FUNCTION)
#undef ADD_FUNCTION
#pragma unroll
      for (int f = 0; f < frames; ++f)
      {
        const int first = BEGIN_OF_FRAME(f), count = BEGIN_OF_FRAME(f + 1) - first;
#pragma unroll
        for (int i = 0; i < MOST_OF_FRAME; ++i)
        {
          if (i < count)
          {
            const int m = first + i;
            const float2 sign = signs_of(bundle, m);
            const real u = multiply_add(sums[f][3], (real)sign.y, sums[f][1]);
            real source = multiply_add(u, (real)sign.x, multiply_add(sums[f][2], (real)sign.y, sums[f][0]));
#pragma unroll
            for (int b = 0; b < BEAMS; ++b)
            {
              source = multiply_add(load_real(x, beams + b * CHANNELS * ROW), (real)of_beams[m * BEAMS + b], source);
            }
            store_real(source, x, out + FIRST(m, c));
          }
        }
      }
    }
  }
}

// Carries the rays of a vector of empty voxels through one segment each. If `deposit`, adds only moment 0 of their path
// integrals.
static inline __attribute__((always_inline)) void PASS_EMPTY(
  sweep_state* state, int y, int x, bool deposit, const __global float** in, __global float* out, float length)
{
  for (int c = 0; c < CHANNELS; ++c)
  {
    real sum = (real)0.0f;
#pragma unroll
    for (int m = 0; m < MEMBERS; ++m)
    {
      const real ray = load_real(x, in[m] + c * ROW);
      sum += ray;
      store_real(ray, x, out + FIRST(m, c));
    }
    __global float* path = ROW_OF(state->planes, PLANE_PATH + c, y);
    if (deposit)
    {
      store_real(multiply_add(sum, (real)length, load_real(x, path)), x, path);
    }
  }
}

// Carries all rays of a row through one segment each, like CROSS_VOXELS, but with a separate source and path integral
// for each direction (member) of the bundle.
static inline __attribute__((always_inline)) void CROSS_MOMENTS(sweep_state* state, int y, int slot, bool first,
  bool deposit, bool thin, const __global float** in, __global float* out, float length,
  const __global BundleInfo* bundle)
{
  const __global float* sigma_row = ROW_OF(state->planes, PlaneSigma, y);
  const __global float* inverse_row = ROW_OF(state->planes, PlaneInverse, y);
  const __global float* sources = state->sources + slot * RAYS_OF_ROW;
  __global float* paths = state->paths + slot * RAYS_OF_ROW;
  __global float* own_row = state->ownPath + slot * ROW;
  const float power = bundle->power;
  const int word = state->words[y];
  for (int x = 0; x < state->width; x += REAL_WIDTH)
  {
    if (!IS_FILLED(word, x, state->segmentBits))
    {
      PASS_EMPTY(state, y, x, deposit, in, out, length);
      continue;
    }
    const real_crossing crossing = cross_length(state, x, sigma_row, inverse_row, length, thin);
    const real mean_length = crossing.meanLength, keep = crossing.keep, change = crossing.change;
    const real shine = mean_length * power;
    const real own = own_path_of(x, &crossing, inverse_row, length) * power;
    store_real(first ? own : own + load_real(x, own_row), x, own_row);
    for (int c = 0; c < CHANNELS; ++c)
    {
#pragma unroll
      for (int m = 0; m < MEMBERS; ++m)
      {
        const int at = FIRST(m, c);
        const real ray = load_real(x, in[m] + c * ROW);
        const real gain = shine * load_real(x, sources + at);
        const real kept = thin ? ray + gain : multiply_add(ray, keep, gain);
        store_real(multiply_add(ray, change, kept), x, out + at);
        const real before = first ? (real)0.0f : load_real(x, paths + at);
        store_real(multiply_add(mean_length, ray, before), x, paths + at);
      }
    }
  }
}

// Adds the path integrals of the bundle's directions to the moments of row y (numerics.md, Eq. (29b)).
// @param frames  number of frames (sets of members that differ only in signs) of the bundle, 1 or 2, a compile-time
//   constant
static inline __attribute__((always_inline)) void GATHER_MOMENTS(sweep_state* state, int y, int slot,
  const __global BundleInfo* bundle, const __global float* coefficients, const int frames)
{
  const int word = state->words[y];
  const __global float* sources = state->sources + slot * RAYS_OF_ROW;
  const __global float* paths = state->paths + slot * RAYS_OF_ROW;
  const __global float* own_row = state->ownPath + slot * ROW;
  BEGIN_PARITIES
  for (int c = 0; c < CHANNELS; ++c)
  {
    __global float* fluence = ROW_OF(state->planes, PLANE_PATH + c, y);
    __global float* higher = state->momentPath + y * state->momentStep + c * state->momentChannel;
    for (int x = 0; x < state->width; x += REAL_WIDTH)
    {
      if (!IS_FILLED(word, x, state->segmentBits))
      {
        continue;
      }
      const int group = IN_ROW(x, functions - 1);
      real sums[MaxFrames][4];
#pragma unroll
      for (int f = 0; f < frames; ++f)
      {
        const int first = BEGIN_OF_FRAME(f), count = BEGIN_OF_FRAME(f + 1) - first;
        sums[f][0] = sums[f][1] = sums[f][2] = sums[f][3] = (real)0.0f;
#pragma unroll
        for (int i = 0; i < MOST_OF_FRAME; ++i)
        {
          if (i < count)
          {
            const int m = first + i;
            const float2 sign = signs_of(bundle, m);
            const int at = FIRST(m, c);
            real path = load_real(x, paths + at);
            path = multiply_add(load_real(x, own_row), load_real(x, sources + at), path);
            sums[f][0] += path;
            sums[f][1] = multiply_add(path, (real)sign.x, sums[f][1]);
            sums[f][2] = multiply_add(path, (real)sign.y, sums[f][2]);
            sums[f][3] = multiply_add(path, (real)(sign.x * sign.y), sums[f][3]);
          }
        }
      }
      real sum = load_real(x, fluence);
#pragma unroll
      for (int f = 0; f < frames; ++f)
      {
        sum = multiply_add(sums[f][0], (real)coefficients[f * functions], sum);
      }
      store_real(sum, x, fluence);
#define ADD_SUM(parity)                                                                    \
  real moment = load_real(group, higher + place);                                          \
  _Pragma("unroll") for (int f = 0; f < frames; ++f)                                       \
  {                                                                                        \
    moment = multiply_add(sums[f][parity], (real)coefficients[f * functions + k], moment); \
  }                                                                                        \
  store_real(moment, group, higher + place);
      OF_ALL_PARITIES(ADD_SUM)
#undef ADD_SUM
    }
  }
}
#undef OF_ALL_PARITIES
#undef FUNCTIONS_OF
#undef BEGIN_PARITIES
#undef BEGIN_OF_FRAME
#undef MOST_OF_FRAME
