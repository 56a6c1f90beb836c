#pragma once

#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedShared.h"

#include "Device/Buffer.h"

#include <vector>

namespace tyndall
{
/// The two memory layouts of volumes (PublishedLayouts). Rows run along the axis u of the ray maps that use the layout.
struct VolumeLayouts : PublishedLayouts
{
  /// Computes the strides of both layouts.
  /// @param width  rows are padded to a multiple of this many floats
  VolumeLayouts(const Grid& grid, int width);

  std::size_t Index(int layout, int x, int y, int z) const;
};

/// Arrays that stay on the device between scattering orders: the medium, the source U, and the moments of the current
/// order and of all orders; [...][channel][volume], with zero padding.
struct PublishedVolumes
{
  /// @param medium  copied
  /// @param model  must outlive this object
  /// @param width  floats that a work-item processes at once
  /// @throws DeviceError if the arrays do not fit the device, or have more voxels than the kernels can address
  PublishedVolumes(Device& device, const Medium& medium, const PublishedModel& model, int width);

  int Channels() const { return this->Model.Channels(); }
  std::size_t LayoutSize(int layout) const; ///< floats of one quantity in all channels

  /// Index of the source U of a source direction among the sources in Sources[layout]; -1 if no ray map reads this
  /// source in this layout.
  int SourceSlot(int layout, int sourceDirection) const { return this->Slots[layout][sourceDirection]; }

  /// Converts an array that is x fastest, with channels interleaved, to memory layout 0 or 1.
  std::vector<float> Arrange(int layout, const float* interleaved) const;
  /// Converts an array in memory layout 0 or 1 to one that is x fastest, with channels interleaved.
  std::vector<float> Interleave(int layout, const float* arranged) const;
  /// Sets the source U from an array [voxel][source direction][channel], x fastest.
  void WriteSource(const std::vector<float>& source);
  /// Adds the uncollided light of another solver to the moments of the order just propagated.
  void AddGiven(const UncollidedImage& image);
  /// Reads the source U into an array [voxel][source direction][channel], x fastest.
  std::vector<float> ReadSource() const;
  /// Reads one moment from an array in layout 0; result x fastest, channels interleaved.
  std::vector<float> ReadMoment(const Buffer<float>& moments, int moment) const;

  /// Reads a range of floats of a buffer; waits for the device.
  std::vector<float> ReadPart(const Buffer<float>& buffer, std::size_t first, std::size_t count) const;

  int Width;
  VolumeLayouts Layouts;
  bool Coloured; ///< whether sigma_t or sigma_s differs between channels

  /// sigma_t, sigma_s, source U and moments of the current order, each in memory layouts 0 and 1 of PublishedLayouts
  Buffer<float> Extinction[2], Scattering[2], Sources[2], OrderMoments[2];
  Buffer<float> Totals; ///< moments of all orders, in memory layout 0
  Buffer<PublishedPart> Parts;

private:
  template <class Value>
  std::vector<float> ArrangeValues(int layout, int channels, Value value) const;
  template <class Visit>
  void ForEach(int layout, int channels, Visit visit) const;
  void MakeMedium(const Medium& medium);
  void FindSlots();
  void MakeSources(const Medium& medium);
  template <class Value>
  void WriteSources(Value value);

  Device& TheDevice;
  Grid TheGrid;
  const PublishedModel& Model;
  std::vector<int> Slots[2];
};
}
