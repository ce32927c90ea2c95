/* The world around the program: it runs three scans. */
#include "scale.h"
#include <stdio.h>

static struct staunch_state state;

int main(void) {
    uint8_t *bytes = (uint8_t *)&state;
    staunch_init(bytes);
    for (int scan = 0; scan < 3; scan++) {
        staunch_context cx = {.now = scan * 10000000LL, .first_scan = scan == 0, .turns = STAUNCH_TURNS, .cycle = 10000000LL};
        uint64_t code = staunch_scan(bytes, &cx, STAUNCH_SCALE);
        if (code != 0) {
            return (int)(code & 0xff);
        }
        printf("%.1f kg%s\n", state.Scale.weight, state.Scale.fault ? ", no answer" : "");
    }
    return 0;
}
