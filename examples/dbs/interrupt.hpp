// Ctrl-C and SIGTERM: the program ends at the last good stage. A second one ends it at once.
#pragma once

namespace dbs {

void catch_interrupts();
// Number of the signal that came; 0: none.
int interrupted();
// Exit status that tells a shell of it: 130 after Ctrl-C.
int exit_status_of_interrupt();

}  // namespace dbs
