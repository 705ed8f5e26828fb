// How fine the picture is where a point lies: client/render/drawn_octree.hpp, whose walk this is.
precision highp int;
precision highp usampler2D;

uniform usampler2D uOctree; // words of the drawn nodes, OCTREE_WIDTH a row
uniform int uOctreePlace;   // of the point's node
uniform int uNodeBits;

uint octreeWord(int place) {
    return texelFetch(uOctree, ivec2(place % OCTREE_WIDTH, place / OCTREE_WIDTH), 0).r;
}

// Bits that are set among the lowest eight; bitCount() came with OpenGL ES 3.1.
int bitsIn(uint byte) {
    uint pairs = byte - ((byte >> 1) & 0x55u);
    uint nibbles = (pairs & 0x33u) + ((pairs >> 2) & 0x33u);
    return int((nibbles + (nibbles >> 4)) & 15u);
}

// Levels below the point's own node: of the deepest drawn node that holds the point (-1: not even its own), and
// of the deepest, drawn or awaited. p: in-node grid integers.
ivec2 walkOctree(uvec3 p) {
    uint word = octreeWord(uOctreePlace);
    ivec2 levels = ivec2((word & 256u) != 0u ? 0 : -1, 0);
    for (int depth = 1; depth <= uNodeBits && (word & 255u) != 0u; ++depth) {
        uvec3 halves = (p >> uint(uNodeBits - depth)) & 1u;
        uint octant = halves.x | halves.y << 1 | halves.z << 2;
        if ((word >> octant & 1u) == 0u)
            break;
        word = octreeWord(int(word >> 9) + bitsIn(word & ((1u << octant) - 1u)));
        levels.y = depth;
        if ((word & 256u) != 0u)
            levels.x = depth;
    }
    return levels;
}
