#ifndef PictureColors_h
#define PictureColors_h

/// Gives new representations in views the colours that the proxy they show asks for in its hints:
///
/// - <DirectColors/>: pictures are shown in their own colours, not mapped to others.
/// - <ColoredBy port="P" array="NAME"/>: of output P, cell array NAME is what is seen, where it is there, whatever the
///   input was coloured by. Where the array's map of colours is new and the array's largest value is a hundred times its
///   smallest or more, the map is logarithmic.
///
/// ParaView has no hint for either. To be called when the plugin is loaded.
void ShowPicturesInTheirColors();

#endif
