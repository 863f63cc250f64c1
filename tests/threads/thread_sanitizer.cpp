// What ThreadSanitizer is told of this program. By itself it takes whatever is received from any socket to
// come after all that was sent on any other, and so would see no race between two threads that both talk to a
// network.

// The sanitizer asks for it by this name; elsewhere nobody does.
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_options() { return "io_sync=0"; }
