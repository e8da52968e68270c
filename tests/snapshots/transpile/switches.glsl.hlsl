// switches
// Made by sssgen for HLSL, shader model 5 and 6 (Direct3D 11 and 12, Vulkan through DXC). Change the source and emit it again rather than this file.
#ifndef SWITCHES_HLSL_INCLUDED
#define SWITCHES_HLSL_INCLUDED

// Every way into, through and out of a switch.
int falling(int kind) {
    int sum = 0;
    if (kind == 0) {
        sum++;
        sum += 10;
    } else if (kind == 1) {
        sum += 10;
    } else if (kind == 2 || kind == 3) {
        sum += 100;
        sum += 1000;
    } else {
        sum += 1000;
    }
    return sum;
}

float default_in_the_middle(int kind) {
    float x = 0.5;
    if (kind == -1) {
        x = 1.0;
    } else if (kind == 7) {
        x *= 2.0;
    } else {
        x += 4.0;
        x *= 2.0;
    }
    return x;
}

float break_inside_an_if(int kind, float limit) {
    float x = 0.0;
    [unroll]
    for (int once = 0; once < 1; once++) {
        if (kind == 1) {
            x = 1.0;
            if (limit > 0.5) {
                break;
            }
            x += 2.0;
        } else if (kind == 2) {
            float kept = limit * 2.0;
            x = kept;
        }
    }
    return x;
}

int continue_of_the_loop(int count) {
    int sum = 0;
    [unroll]
    for (int i = 0; i < 8; i++) {
        int selected = i % 4;
        bool goes_on = false;
        [unroll]
        for (int once = 0; once < 1; once++) {
            if (selected == 0) {
                goes_on = true;
                break;
            } else if (selected == 1) {
                if (count > 3) {
                    break;
                }
                sum += 5;
                sum++;
            } else {
                sum++;
            }
        }
        if (goes_on) {
            continue;
        }
        sum += 100;
    }
    return sum;
}

float3 leaves_at_once(uint kind) {
    if (kind == 0u) {
        return float3(1.0, 0.0, 0.0);
    } else if (kind == 1u) {
        return float3(0.0, 1.0, 0.0);
    }
    return float3(0.0, 0.0, 1.0);
}

int nested(int a, int b) {
    int found = 0;
    if (a == 0) {
        if (b == 0) {
            found = 1;
        } else {
            found = 2;
        }
        found *= 3;
    } else if (a == 1) {
        [unroll]
        for (int i = 0; i < 4; i++) {
            if (i == b) {
                break;
            }
            found += i;
        }
        found += 50;
    }
    return found;
}

int counted_once(inout int n) {
    int n_before = n;
    n++;
    if (n_before == 0) {
        return 10;
    } else if (n_before == 1) {
        n += 5;
    } else {
        n = 0;
    }
    return n;
}

#endif
