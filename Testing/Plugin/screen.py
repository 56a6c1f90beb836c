"""What an X display shows, without the pointer."""
import ctypes


class Screen:
    def __init__(self):
        self.x11 = ctypes.CDLL("libX11.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
        self.x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x11.XGetImage.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_int, ctypes.c_uint,
                                       ctypes.c_uint, ctypes.c_ulong, ctypes.c_int]
        self.x11.XGetImage.restype = ctypes.POINTER(ctypes.c_int * 6)  # width, height, xoffset, format, and data
        self.display = self.x11.XOpenDisplay(None)
        self.root = self.x11.XDefaultRootWindow(self.display)

    def pixels(self, x, y, width, height):
        """@return bytes: blue, green, red, nothing of each pixel, by rows from the top"""
        image = self.x11.XGetImage(self.display, self.root, x, y, width, height, 0xFFFFFFFF, 2)
        data = ctypes.cast(ctypes.byref(image.contents, 16), ctypes.POINTER(ctypes.c_void_p)).contents.value
        return ctypes.string_at(data, 4 * width * height)
