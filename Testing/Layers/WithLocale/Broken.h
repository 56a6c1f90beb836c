#include <cstdio>
inline void Write(char* text, double number) { std::snprintf(text, 32, "%g", number); }
