// One line that clang-format would change.
int  Two( );
