#ifndef PictureColors_h
#define PictureColors_h

/// Shows the outputs of proxies with the hint <DirectColors/> in their own colours: their representations start with
/// MapScalars 0. ParaView would look bytes of red, green and blue up in a colour map.
///
/// To be called when the plugin is loaded; serves windows and scripts.
void ShowPicturesInTheirColors();

#endif
