#ifndef VolumeColors_h
#define VolumeColors_h

class vtkSMProxy;

/// Follows a representation of an output whose proxy has the hint
///
///   <VolumeColors port="P" array="NAME" distance="FACT"/>
///
/// Cell array NAME has red, green, blue and alpha of voxels, as bytes; field data FACT is the distance across which
/// alpha is a voxel's opacity. Where the array is there, the output opens as ParaView's Volume in these colours, as it
/// is when Volume is chosen later: Map Scalars off, an opacity function from 0 to 1 over 0 to 255 that is not rescaled,
/// the unit distance as it is in the data. Other arrays are mapped again when they are chosen.
///
/// To be called when the representation is registered.
void FollowVolumeColors(vtkSMProxy* representation);

#endif
