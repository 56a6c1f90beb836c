#pragma once

#include "vtkSmartPointer.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;
class vtkMultiProcessController;

namespace tyndall
{
class PieceLayout;
class StreamedMembers;
struct PieceValues;

/// Gathers an image that is distributed in pieces, on the first rank or on every rank. Arrays are gathered one at a
/// time, so that only one array is in memory twice.
///
/// Pieces may overlap and may have ghost cells (vtkGhostType). PieceLayout chooses the piece from which a cell or point
/// is taken; values owned by several pieces must be equal. Ranks without cells are ignored. Field data are taken from
/// the first piece; the phase function in field data must be the same on all pieces. With one rank nothing is copied.
///
/// The constructor and the access to arrays are collective, with the arrays in the same order on all ranks; an error on
/// one rank throws InvalidInput on all.
class GatheredImage
{
public:
  enum class On
  {
    FirstRank,
    EveryRank,
  };

  using Arrays = std::vector<vtkSmartPointer<vtkDataArray>>;

  /// Gathers geometry, field data and flags; CellArray and PointArray gather the arrays. Collective.
  /// @param controller  null: there is one rank
  /// @param piece       may be null or without cells
  /// @param cells, points  arrays of the piece, one tuple for each cell or point, in any order
  /// @param refusal     beginning of error messages, e.g. "The image is not written"
  /// @throws InvalidInput if the pieces leave a gap, lie on different grids or have different arrays
  GatheredImage(vtkMultiProcessController* controller, vtkImageData* piece, Arrays cells, Arrays points, On where,
    const std::string& refusal);
  ~GatheredImage();

  bool IsFirstRank() const { return this->Rank == 0; }
  int NumberOfCellArrays() const { return static_cast<int>(this->Own[Cells].size()); }
  int NumberOfPointArrays() const { return static_cast<int>(this->Own[Points].size()); }

  /// The complete image, with extent, geometry and field data but without arrays. Null if no piece has cells, and on
  /// ranks on which the image is not gathered.
  vtkImageData* Frame() const { return this->Whole; }

  /// Flag of each cell, or of each point: whether vtkGhostType hides it. Null if none is hidden, or on ranks on which
  /// the image is not gathered.
  const std::vector<unsigned char>* HiddenCells() const { return this->HiddenOf(Cells); }
  const std::vector<unsigned char>* HiddenPoints() const { return this->HiddenOf(Points); }

  /// Gathers the cell, or point, array number `index`. Collective.
  /// @return null on ranks on which the image is not gathered
  vtkSmartPointer<vtkDataArray> CellArray(int index) { return this->Array(Cells, index); }
  vtkSmartPointer<vtkDataArray> PointArray(int index) { return this->Array(Points, index); }

private:
  enum Kind
  {
    Cells,
    Points,
    Kinds,
  };

  struct ArrayKind
  {
    std::string Name;
    int Type = 0;
    int Components = 0;

    void Stream(StreamedMembers& members);
  };

  /// Description of the piece on one rank, known to every rank.
  struct Piece
  {
    std::array<int, 6> Extent = { 0, -1, 0, -1, 0, -1 };
    std::array<double, 15> Place = {}; ///< origin, spacing and direction matrix
    std::array<std::vector<ArrayKind>, Kinds> Arrays;
    std::array<bool, Kinds> HasFlags = {};
    std::string Phase; ///< the phase function in the piece's field data

    void Stream(StreamedMembers& members);
    bool HasCells() const { return this->Extent[0] <= this->Extent[1]; }
  };

  bool IsHere() const { return this->Where == On::EveryRank || this->IsFirstRank(); }
  const std::vector<unsigned char>* HiddenOf(Kind kind) const
  {
    return this->Hidden[kind].empty() ? nullptr : &this->Hidden[kind];
  }
  [[noreturn]] void Refuse(const std::string& why) const;
  Piece Describe(vtkImageData* piece) const;
  int FirstWithCells() const;
  void CheckPieces(int first) const;
  void CheckArrays(int first, int other, Kind kind) const;
  void Sort(Kind kind, const Piece& first);
  void MakeWhole(int first);
  std::vector<PieceValues> ShareFlags(Kind kind, const std::vector<unsigned char>& own) const;
  void LayOut(Kind kind, const std::vector<unsigned char>& own);
  void ShareFieldData(vtkImageData* piece, int from);
  vtkIdType CountOf(Kind kind, int rank) const;
  void Bring(const char* own, char* values, vtkIdType bytes, int from) const;
  vtkSmartPointer<vtkDataArray> Array(Kind kind, int index);
  void CheckOverlap(Kind kind, int rank, const char* values, vtkDataArray* whole) const;

  vtkMultiProcessController* Controller;
  On Where;
  std::string Refusal;
  int Rank = 0, Ranks = 1;
  std::array<Arrays, Kinds> Own; ///< arrays of this rank's piece; null if it has none
  vtkSmartPointer<vtkImageData> Whole;
  std::vector<Piece> Pieces;
  /// Assignment of cells, and of points, to pieces; null with one rank, and on ranks that do not gather the image.
  std::array<std::unique_ptr<PieceLayout>, Kinds> Layouts;
  std::array<std::vector<unsigned char>, Kinds> Hidden;
};
}
