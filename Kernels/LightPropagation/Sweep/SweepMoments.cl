// A bundle through a row where light is gathered, and shines, in angular moments (numerics.md, section 4.7). Compiled
// once for each number of MEMBERS, by SweepBundle.cl.
//
// Members of a frame differ in the signs of u and v alone: each angular function has one value for all of them, but for
// its sign. Functions are summed up by their parity along u and v, four sums for up to four members, instead of one for
// each member.

#define MOST_OF_FRAME (MEMBERS < 4 ? MEMBERS : 4)

// Sum of coefficient times row over functions [begin, begin + count).
#define ADD_FUNCTIONS(sum, begin, count)                                                \
  _Pragma("unroll") for (int k = begin; k < begin + count; ++k)                         \
  {                                                                                     \
    sum = multiply_add(load_real(x, row + k * CHANNELS * ROW), (real)of_frame[k], sum); \
  }

// The source in the direction of each member, in row y, into slot `slot`. Rows lie as those of the rings, whose last
// row's border is the first one's here.
static void FIND_SOURCES(
  sweep_state* state, int y, int slot, const __global BundleInfo* bundle, const __global float* coefficients)
{
  __global float* out = state->sources + slot * RAYS_OF_ROW;
  const __global float* of_beams = coefficients + bundle->frames * MOMENTS;
  for (int f = 0; f < bundle->frames; ++f)
  {
    const __global float* of_frame = coefficients + f * MOMENTS;
    const int first = bundle->firstOfFrame[f];
    const int count = bundle->firstOfFrame[f + 1] - first;
    for (int c = 0; c < CHANNELS; ++c)
    {
      const __global float* row = ROW_OF(state->planes, PlaneSource + c, y);
      const __global float* beams = ROW_OF(state->planes, PLANE_BEAMS + c, y);
      for (int x = 0; x < state->width; x += REAL_WIDTH)
      {
        real ee = (real)0.0f, oe = (real)0.0f, eo = (real)0.0f, oo = (real)0.0f;
        ADD_FUNCTIONS(ee, 0, EVEN_EVEN)
        ADD_FUNCTIONS(oe, EVEN_EVEN, ODD_EVEN)
        ADD_FUNCTIONS(eo, EVEN_EVEN + ODD_EVEN, EVEN_ODD)
        ADD_FUNCTIONS(oo, EVEN_EVEN + ODD_EVEN + EVEN_ODD, ODD_ODD)
#pragma unroll
        for (int i = 0; i < MOST_OF_FRAME; ++i)
        {
          if (i < count)
          {
            const int m = first + i;
            const float2 sign = signs_of(bundle, m);
            const real u = multiply_add(oo, (real)sign.y, oe);
            real source = multiply_add(u, (real)sign.x, multiply_add(eo, (real)sign.y, ee));
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

// All rays of a row through one segment each, as CROSS_VOXELS has it, but for a source of each member's own, and a path
// of its own.
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
  for (int x = 0; x < state->width; x += REAL_WIDTH)
  {
    const real_crossing crossing = cross_length(state, x, sigma_row, inverse_row, length, thin);
    const real mean_length = crossing.meanLength, keep = crossing.keep, change = crossing.change;
#if SOURCE
    const real shine = mean_length * power;
    const real own = own_path_of(x, &crossing, inverse_row, length) * power;
    store_real(first ? own : own + load_real(x, own_row), x, own_row);
#endif
#pragma unroll
    for (int i = 0; i < MEMBERS * CHANNELS; ++i)
    {
      const int at = i * ROW + PAD;
      const real ray = load_real(x, in[i / CHANNELS] + i % CHANNELS * ROW);
#if SOURCE
      const real gain = shine * load_real(x, sources + at);
      const real kept = thin ? ray + gain : multiply_add(ray, keep, gain);
#else
      const real kept = thin ? ray : ray * keep;
#endif
      store_real(multiply_add(ray, change, kept), x, out + at);
      const real before = first ? (real)0.0f : load_real(x, paths + at);
      store_real(multiply_add(mean_length, ray, before), x, paths + at);
    }
  }
}

// Adds the members' paths to the moments of row y.
static void GATHER_MOMENTS(
  sweep_state* state, int y, int slot, const __global BundleInfo* bundle, const __global float* coefficients)
{
  const __global float* sources = state->sources + slot * RAYS_OF_ROW;
  const __global float* paths = state->paths + slot * RAYS_OF_ROW;
  const __global float* own_row = state->ownPath + slot * ROW;
  for (int f = 0; f < bundle->frames; ++f)
  {
    const __global float* of_frame = coefficients + f * MOMENTS;
    const int first = bundle->firstOfFrame[f];
    const int count = bundle->firstOfFrame[f + 1] - first;
    for (int c = 0; c < CHANNELS; ++c)
    {
      __global float* row = ROW_OF(state->planes, PLANE_PATH + c, y);
      for (int x = 0; x < state->width; x += REAL_WIDTH)
      {
        real ee = (real)0.0f, oe = (real)0.0f, eo = (real)0.0f, oo = (real)0.0f;
#pragma unroll
        for (int i = 0; i < MOST_OF_FRAME; ++i)
        {
          if (i < count)
          {
            const int m = first + i;
            const float2 sign = signs_of(bundle, m);
            const int at = FIRST(m, c);
            real path = load_real(x, paths + at);
#if SOURCE
            path = multiply_add(load_real(x, own_row), load_real(x, sources + at), path);
#endif
            ee += path;
            oe = multiply_add(path, (real)sign.x, oe);
            eo = multiply_add(path, (real)sign.y, eo);
            oo = multiply_add(path, (real)(sign.x * sign.y), oo);
          }
        }
#pragma unroll
        for (int k = 0; k < MOMENTS; ++k)
        {
          const real sum = k < EVEN_EVEN          ? ee
            : k < EVEN_EVEN + ODD_EVEN            ? oe
            : k < EVEN_EVEN + ODD_EVEN + EVEN_ODD ? eo
                                                  : oo;
          __global float* moment = row + k * CHANNELS * ROW;
          store_real(multiply_add(sum, (real)of_frame[k], load_real(x, moment)), x, moment);
        }
      }
    }
  }
}
#undef ADD_FUNCTIONS
#undef MOST_OF_FRAME
