#pragma once

namespace tyndall
{
/// Tags of messages between ranks (Communicator.h), one per kind of message. Sweeps and lattice steps number their
/// messages from 0 on, below these tags.
namespace MessageTag
{
constexpr int ListsOfWords = 29990;     ///< PictureOfBlocks.cxx
constexpr int ReceiptsOfDepths = 29991; ///< ShadowsInBlocks.cxx
constexpr int ColumnsOfSight = 29992;   ///< LitColor.cxx
constexpr int DepthsOfLamps = 29993;    ///< ShadowsInBlocks.cxx
constexpr int CornersOfPaths = 29995;   ///< PhotonPaths.cxx
constexpr int RunsOfBytes = 29996;      ///< BrickedBytes.cxx
constexpr int NumbersOfEach = 29997;    ///< BoxExchange.cxx
constexpr int GhostCells = 29998;       ///< GhostCells.cxx
constexpr int ValuesOfBoxes = 29999;    ///< BoxExchange.cxx
constexpr int Sums = 30000;             ///< Communicator.cxx, as are those that follow
constexpr int Agreements = 30001;
constexpr int Parcels = 30002;
constexpr int Count = 30010; ///< all tags are smaller
}
}
