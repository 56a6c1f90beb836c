#pragma once

#include "vtkSmartPointer.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;
class vtkMultiProcessController;
class vtkMultiProcessStream;

/// For writers that run on several ranks, and write on the first.
namespace tyndall
{
/// Does something on each rank. All of them have to call it.
/// @param controller  null: there is one rank
/// @throws InvalidInput on every rank, with the same words, where it threw on any of them
void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act);

/// An image whose pieces lie on several ranks, put together on the first: one array after the other, so that no more
/// than one is there twice.
///
/// A cell is taken from the first rank that does not flag it as a duplicate (vtkGhostType). With one rank nothing is
/// copied.
///
/// All ranks have to construct it and to ask for the arrays in the same order; what fails on one throws InvalidInput on
/// all.
class GatheredImage
{
public:
  /// @param controller  null: there is one rank
  /// @param piece       may be null or without cells
  /// @param cells       its arrays, each with a value for each cell
  /// @throws InvalidInput where pieces leave a gap, lie on different grids or have different arrays
  GatheredImage(
    vtkMultiProcessController* controller, vtkImageData* piece, std::vector<vtkSmartPointer<vtkDataArray>> cells);

  bool IsFirstRank() const { return this->Rank == 0; }
  int NumberOfArrays() const { return static_cast<int>(this->Arrays.size()); }

  /// On the first rank: the whole image's extent, place and field data, without arrays. Null where no piece has cells.
  vtkImageData* Frame() const { return this->Whole; }

  /// On the first rank: a flag for each cell that is hidden by vtkGhostType; null: none is.
  const std::vector<unsigned char>* Hidden() const { return this->HiddenCells.empty() ? nullptr : &this->HiddenCells; }

  /// The whole array, on the first rank; null on others.
  vtkSmartPointer<vtkDataArray> Array(int index);

private:
  struct ArrayKind
  {
    std::string Name;
    int Type = 0;
    int Components = 0;

    bool operator==(const ArrayKind& other) const
    {
      return this->Name == other.Name && this->Type == other.Type && this->Components == other.Components;
    }
  };

  /// What the first rank knows of each piece.
  struct Piece
  {
    std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };
    std::array<double, 15> Place = {}; ///< origin, spacing, direction
    std::vector<ArrayKind> Arrays;
    std::vector<unsigned char> Ghosts; ///< of each cell; empty: none is one

    bool HasCells() const { return this->Extent[0] <= this->Extent[1]; }
    vtkIdType Count() const;
  };

  Piece Describe(vtkImageData* piece) const;
  void GatherPieces(const Piece& own);
  Piece Receive(vtkMultiProcessStream& stream, int rank, const Piece& own) const;
  void PutTogether(vtkImageData* piece);
  int FirstWithCells() const;
  void CheckPieces(int first) const;
  void MakeWhole(int first);
  void FindOwners();
  void GatherFieldData(vtkImageData* piece, int from);
  vtkSmartPointer<vtkDataArray> NewArray(const ArrayKind& kind) const;
  void Paste(int rank, const char* values, vtkDataArray* whole) const;
  template <typename Do>
  void ForCells(const Piece& piece, const Do& act) const;

  vtkMultiProcessController* Controller;
  int Rank = 0, Ranks = 1;
  std::vector<vtkSmartPointer<vtkDataArray>> Arrays; ///< of the own piece, or null
  vtkSmartPointer<vtkImageData> Whole;
  std::vector<Piece> Pieces; ///< on the first rank
  std::vector<int> Owners;   ///< on the first rank: which rank each cell is taken from
  std::vector<unsigned char> HiddenCells;
};
}
