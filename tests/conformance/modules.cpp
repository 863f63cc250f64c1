// The program's loader, compiled into this test program: app/ is not a library.
#include "app/modules.cpp"
