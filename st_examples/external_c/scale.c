/* What the program calls is C: a converter, and an average. */
#include "scale.h"

/* A real one would ask its driver. This one answers on channel 2, with a load that grows. */
int16_t ReadChannel(int16_t channel, bool *ok) {
    static int16_t load = 380;
    load += 20;
    *ok = channel == 2;
    return load;
}

void Average(struct Average *block, const staunch_context *cx) {
    (void)cx;
    int16_t sum = block->value;
    for (int at = 3; at > 0; at--) {
        block->last[at] = block->last[at - 1];
        sum += block->last[at];
    }
    block->last[0] = block->value;
    if (block->count < 4) {
        block->count++;
    }
    block->mean = (float)sum / (float)block->count;
}
