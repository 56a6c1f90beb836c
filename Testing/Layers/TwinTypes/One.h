#pragma once
// Broken on purpose, with Other.h: types_have_one_meaning.py must find the pair that this project once had, and it
// alone.
namespace tyndall
{
struct Ahead;

template <class Number>
struct Box
{
  Number first[3];
};

struct VoxelBox
{
  int first[3] = {}, size[3] = {};
};

enum class Kind
{
  One
};
}

namespace other
{
struct Grid
{
  int size;
};
}
