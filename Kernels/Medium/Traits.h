#pragma once

#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// The colour that several lights have in common, if they have one. Black has every colour.
class CommonColour
{
public:
  void Add(const Rgb& rgb);
  void Add(const float* rgb, std::size_t count); ///< `count` colours, interleaved

  bool IsOne() const { return this->One; } ///< all are multiples of one, to rounding (3e-7, each component)
  bool IsGrey() const;                     ///< of white, exactly
  int Brightest() const;                   ///< the channel that has most
  Rgb Relative() const;                    ///< that colour, its brightest channel 1; white where all are black
  bool IsBlack() const { return this->Sum == Rgb{}; } ///< none of them shines

private:
  bool One = true;
  Rgb First = {}; ///< of those that are not black
  Rgb Sum = {};
};

/// A box of voxels within a grid.
struct VoxelBox
{
  std::array<int, 3> first = { 0, 0, 0 };
  std::array<int, 3> size = { 0, 0, 0 };

  std::size_t VoxelCount() const
  {
    return static_cast<std::size_t>(this->size[0]) * static_cast<std::size_t>(this->size[1]) *
      static_cast<std::size_t>(this->size[2]);
  }
};

/// What a medium does not do, so that solvers can leave it out. Found in one scan of its arrays (some milliseconds for
/// 128^3 voxels).
struct MediumTraits
{
  bool absorbs = false;       ///< sigma_a is not zero everywhere
  bool scatters = false;      ///< sigma_s
  bool emits = false;         ///< emission
  bool isotropic = true;      ///< g is 0, or nothing scatters
  bool grey = true;           ///< sigma_a and sigma_s are the same in all channels (to 2e-7)
  bool greyExtinction = true; ///< their sum is; always where `grey` is
  CommonColour emission;
  VoxelBox filled; ///< the smallest box outside of which there is no medium: neither sigma_t nor emission
};

/// @param similarity  1, or 1 - g where sigma_s (1 - g) stands for sigma_s in sigma_t
MediumTraits TraitsOf(const Medium& medium, double similarity = 1.0);

/// The colour of all that shines from outside, and of the lights inside.
CommonColour ColourOf(const Illumination& illumination);

/// The words for what is left out, the same in every solver.
namespace left_out
{
extern const char* const Grey;           ///< neither medium nor light has colour
extern const char* const OneColour;      ///< the medium is grey, and light has one colour
extern const char* const GreyExtinction; ///< one transmittance for three channels
extern const char* const NoScattering;
extern const char* const NoAbsorption;
extern const char* const NoEmission;
extern const char* const OneOrder; ///< nothing is scattered though the medium could
extern const char* const NetFlux;
extern const char* const Isotropic;
extern const char* const ConstantIndex;
extern const char* const EmptyBricks;
extern const char* const NoLights;
extern const char* const NoEmissionPeaks; ///< what the medium emits needs no rays of its own
extern const char* const DarkOutside;     ///< neither environment nor sky nor faces shine
extern const char* const EvenOutside;     ///< they shine evenly: directions of its own are not needed
std::string EmptySlabs(const VoxelBox& filled, const Grid& grid);
std::string DarkDirections(double lit); ///< part of the rays
std::string MirrorImages(int classes, int directions);
std::string DirectionsAlongSlab(int perFace); ///< solved with instead
}
}
