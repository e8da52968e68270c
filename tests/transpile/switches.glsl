#version 330
// Every way into, through and out of a switch.

int falling(int kind) {
    int sum = 0;
    switch (kind) {
        case 0:
            sum += 1;
        case 1:
            sum += 10;
            break;
        case 2:
        case 3:
            sum += 100;
        default:
            sum += 1000;
    }
    return sum;
}

float default_in_the_middle(int kind) {
    float x = 0.5;
    switch (kind) {
        case -1:
            x = 1.0;
            break;
        default:
            x += 4.0;
        case 7:
            x *= 2.0;
    }
    return x;
}

float break_inside_an_if(int kind, float limit) {
    float x = 0.0;
    switch (kind) {
        case 1:
            x = 1.0;
            if (limit > 0.5) {
                break;
            }
            x += 2.0;
            break;
        case 2: {
            float kept = limit * 2.0;
            x = kept;
        }
    }
    return x;
}

int continue_of_the_loop(int count) {
    int sum = 0;
    for (int i = 0; i < 8; i++) {
        switch (i % 4) {
            case 0:
                continue;
            case 1:
                if (count > 3) {
                    break;
                }
                sum += 5;
            default:
                sum += 1;
        }
        sum += 100;
    }
    return sum;
}

vec3 leaves_at_once(uint kind) {
    switch (kind) {
        case 0u:
            return vec3(1.0, 0.0, 0.0);
        case 1u:
            return vec3(0.0, 1.0, 0.0);
    }
    return vec3(0.0, 0.0, 1.0);
}

int nested(int a, int b) {
    int found = 0;
    switch (a) {
        case 0:
            switch (b) {
                case 0:
                    found = 1;
                    break;
                default:
                    found = 2;
            }
            found *= 3;
            break;
        case 1:
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
    switch (n++) {
        case 0: return 10;
        case 1: n += 5; break;
        default: n = 0; break;
    }
    return n;
}
