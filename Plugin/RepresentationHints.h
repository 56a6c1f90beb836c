#ifndef RepresentationHints_h
#define RepresentationHints_h

/// Has new representations in views begin as the proxy that they show asks for in its hints. ParaView has no hints for:
///
/// - <DirectColors port="P"/>: output P (every output where none is named) is shown in its own colours, without a bar.
///   ParaView would look bytes of red, green and blue up in a map of colours.
/// - <ColoredBy port="P" array="NAME"/>: of output P, cell array NAME is what is seen, where it is there, whatever the
///   input was coloured by. Where the array's map of colours is new and the array's largest value is a hundred times
///   its smallest or more, the map is logarithmic. What opens as Lit Volume, which uses no map, is coloured when it is
///   first shown in another way.
/// - <Plotted port="P" x="NAME" y="NAME NAME ..."/>: a line chart of table P begins with these columns, not with all
///   over the row's number. Its left axis is logarithmic where nothing else is in the view. With y_begin="TEXT" columns
///   whose names begin so are plotted as well; with style="points" rows are points, not joined by lines, and both axes
///   are logarithmic.
/// - <VolumeColors .../>: see VolumeColors.h.
///
/// To be called when the plugin is loaded; serves windows and scripts.
void FollowRepresentationHints();

#endif
