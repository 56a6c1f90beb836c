#pragma once
// See One.h.
namespace tyndall
{
struct Ahead;

/* struct Box { */
namespace
{
enum class Kind
{
  Other = '{'
};
}

struct VoxelBox final
{
  long Min[3] = {}, Max[3] = {};
};

template <class Box>
struct Grid
{
  Box box;
};

inline const char* Text()
{
  struct Box
  {
    const char* text = "struct Box {";
  };
  return Box().text;
}
}
