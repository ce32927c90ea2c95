/* The world around the program: it runs three scans. */
#include "scale.h"
#include <stdio.h>

_Alignas(STAUNCH_STATE_ALIGN) static uint8_t state[STAUNCH_STATE_SIZE];

int main(void) {
    staunch_init(state);
    for (int scan = 0; scan < 3; scan++) {
        staunch_context cx = {scan * 10000000LL, scan == 0, STAUNCH_TURNS, 10000000LL};
        uint64_t code = staunch_scan(state, &cx, STAUNCH_SCALE);
        if (code != 0) {
            return (int)(code & 0xff);
        }
        printf("%.1f kg%s\n", STAUNCH_SCALE_WEIGHT(state), STAUNCH_SCALE_FAULT(state) ? ", no answer" : "");
    }
    return 0;
}
