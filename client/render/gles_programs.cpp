#include "client/render/gles_programs.hpp"

#include "client/render/drawn_octree.hpp"
#include "client/render/shader_texts.hpp"
#include "shared/base/text.hpp"

namespace stipple::gles {

namespace {

std::string definesFor(const PointVariant& variant) {
    std::string defines = variant.lowWords ? "#define LOW_WORDS\n" : "";
    defines += variant.circle ? "#define CIRCLE\n" : "";
    defines += variant.paraboloid ? "#define PARABOLOID\n" : "";
    defines += variant.disc ? "#define DISC\n" : "";
    defines += variant.normals ? "#define NORMALS\n" : "";
    defines += variant.circle || variant.disc || variant.blend ? "#define CENTRED\n" : "";
    defines += variant.collect ? "#define COLLECT\n" : "";
    defines += variant.blend ? "#define BLEND\n" : "";
    defines += variant.identity ? "#define IDENTITY\n" : "";
    defines += variant.captureLevels ? "#define CAPTURE_LEVELS\n" : "";
    defines += variant.adaptive ? "#define ADAPTIVE\n" : "";
    defines += variant.growing ? cat("#define GROWING\n#define MAX_DOUBLINGS ", maxDoublings, "\n") : "";
    if (variant.walksOctree())
        defines += cat("#define OCTREE_WIDTH ", octreeTextureWidth, "\n");
    return defines;
}

} // namespace

PointVariant PointVariant::of(const RasterFrame& frame, const DrawNode& node) {
    PointVariant variant;
    variant.lowWords = node.node->positionShift > 0;
    variant.disc = variant.normals = frame.disc && node.normals;
    variant.circle = frame.circle && !variant.disc;
    variant.paraboloid = frame.paraboloid;
    variant.adaptive = frame.adaptive;
    variant.growing = frame.growing;
    return variant;
}

void PointPrograms::start(const PointVariant& variant) {
    if (!made_.contains(variant) && !started_.contains(variant))
        started_.emplace(variant, PointProgram::start(variant));
}

Result<const PointProgram*> PointPrograms::get(const PointVariant& variant) {
    auto found = made_.find(variant);
    if (found == made_.end()) {
        start(variant);
        STIPPLE_TRY(program, PointProgram::finish(std::move(started_.extract(variant).mapped())));
        found = made_.emplace(variant, std::move(program)).first;
    }
    return &found->second;
}

Program PointProgram::start(const PointVariant& variant) {
    std::string vertex = cat(variant.walksOctree() ? shader_texts::octree : "", shader_texts::sprite,
                             variant.expand ? shader_texts::expandVertex : shader_texts::pointsVertex);
    return startProgram(definesFor(variant), vertex.c_str(), shader_texts::pointsFragment,
                        variant.captureLevels ? "vLevels" : nullptr);
}

Result<PointProgram> PointProgram::finish(Program program) {
    STIPPLE_CHECK(checkProgram(program));
    PointProgram made;
    auto at = [&](const char* name) { return glGetUniformLocation(program.id(), name); };
    made.cell = at("uCell");
    made.fraction = at("uFraction");
    made.rowX = at("uRowX");
    made.rowY = at("uRowY");
    made.rowD = at("uRowD");
    made.positionShift = at("uPositionShift");
    made.deep = at("uDeep");
    made.fractionBits = at("uFractionBits");
    made.lowX = at("uLowX");
    made.highX = at("uHighX");
    made.lowY = at("uLowY");
    made.highY = at("uHighY");
    made.origin = at("uOrigin");
    made.centre = at("uCentre");
    made.part = at("uPart");
    made.nearFar = at("uNearFar");
    made.nearBits = at("uNearBits");
    made.depthShift = at("uDepthShift");
    made.perspective = at("uPerspective");
    made.sizeByDistance = at("uSizeByDistance");
    made.size64 = at("uSize64");
    made.worldSize64 = at("uWorldSize64");
    made.sizeRange64 = at("uSizeRange64");
    made.rank = at("uRank");
    made.continuous = at("uContinuous");
    made.growth = at("uGrowth");
    made.falloff = at("uFalloff");
    made.leastDensity = at("uLeastDensity");
    made.sizeByDensity = at("uSizeByDensity");
    made.octree = at("uOctree");
    made.octreePlace = at("uOctreePlace");
    made.nodeBits = at("uNodeBits");
    made.nodeSize64 = at("uNodeSize64");
    made.radiusScale = at("uRadiusScale");
    made.blendFactor = at("uBlendFactor");
    made.discAxes = at("uDiscAxes");
    made.pixelUnits = at("uPixelUnits");
    made.pixelSlope = at("uPixelSlope");
    made.nearest = at("uNearest");
    made.hardness = at("uHardness");
    made.nodeIndex = at("uNode");
    made.window = at("uWindow");
    made.centreColours = at("uCentreColours");
    made.centreDepths = at("uCentreDepths");
    made.centrePlaces = at("uCentrePlaces");
    made.columns = at("uColumns");
    made.centrePoints = at("uCentrePoints");
    made.centreWindow = at("uCentreWindow");
    made.program = std::move(program);
    return made;
}

void PointProgram::useFor(const RasterFrame& frame) const {
    glUseProgram(program.id());
    glUniform2f(centre, frame.centreX, frame.centreY);
    glUniform4i(part, frame.left, frame.bottom, frame.width, frame.height);
    glUniform2f(nearFar, frame.near, frame.far);
    glUniform1ui(nearBits, frame.nearBits);
    glUniform1i(depthShift, frame.depthShift);
    glUniform1i(perspective, frame.perspective);
    glUniform1i(sizeByDistance, frame.sizeByDistance);
    glUniform1f(size64, static_cast<float>(frame.size64));
    glUniform1f(worldSize64, frame.worldSize64);
    glUniform2f(sizeRange64, static_cast<float>(frame.minSize64), static_cast<float>(frame.maxSize64));
    glUniform1i(octree, octreeUnit);
    glUniform1f(radiusScale, frame.radiusScale);
    glUniform1f(blendFactor, frame.blendFactor);
    std::array<float, 9> axes{};
    for (std::size_t i = 0; i < 3; ++i) {
        axes[i] = frame.discRight[i];
        axes[3 + i] = frame.discUp[i];
        axes[6 + i] = frame.discForward[i];
    }
    glUniformMatrix3fv(discAxes, 1, GL_FALSE, axes.data());
    glUniform1f(pixelUnits, frame.pixelUnits);
    glUniform1f(pixelSlope, frame.pixelSlope);
    glUniform1i(nearest, nearestUnit);
    glUniform1i(hardness, frame.hardness);
    glUniform1i(centreColours, centreColoursUnit);
    glUniform1i(centreDepths, centreDepthsUnit);
    glUniform1i(centrePlaces, centrePlacesUnit);
    glUniform1i(columns, frame.width);
    glUniform1i(centrePoints, centrePointsUnit);
    glUniform1i(continuous, frame.continuous);
    glUniform1f(growth, frame.growth);
    glUniform2f(falloff, frame.falloffX, frame.falloffY);
    glUniform1f(leastDensity, frame.leastDensity);
    glUniform1i(sizeByDensity, frame.sizeByDensity);
}

void PointProgram::setNode(const RasterNode& node) const {
    glUniform3iv(cell, 1, node.cell.data());
    glUniform3fv(fraction, 1, node.fraction.data());
    glUniform3fv(rowX, 1, node.rowX.data());
    glUniform3fv(rowY, 1, node.rowY.data());
    glUniform3fv(rowD, 1, node.rowD.data());
    glUniform1i(positionShift, node.positionShift);
    glUniform1i(deep, node.deep);
    if (node.deep) {
        glUniform1i(fractionBits, node.fractionBits);
        glUniform3uiv(lowX, 1, node.lowX.data());
        glUniform3uiv(highX, 1, node.highX.data());
        glUniform3uiv(lowY, 1, node.lowY.data());
        glUniform3uiv(highY, 1, node.highY.data());
        glUniform2ui(origin, node.originX, node.originY);
    }
    glUniform2f(rank, node.rankBase, node.rankStep);
    glUniform1f(nodeSize64, node.nodeSize64);
}

void PointProgram::setIdentity(std::uint32_t node, int left, int bottom) const {
    glUniform1ui(nodeIndex, node);
    glUniform2i(window, left, bottom);
}

void PointProgram::setIdentityWindows(const PictureWindow& centres, const PictureWindow& written) const {
    glUniform1i(columns, centres.width);
    glUniform2i(centreWindow, centres.left, centres.bottom);
    glUniform2i(window, written.left, written.bottom);
}

void PointProgram::setOctreePlace(std::uint32_t place, const ResidentNode& node) const {
    glUniform1i(octreePlace, static_cast<GLint>(place));
    glUniform1i(nodeBits, node.nodeBits);
}

Program ResolveProgram::start(bool splats) {
    return startProgram(splats ? "#define SPLATS\n" : "", shader_texts::resolveVertex,
                        shader_texts::resolveFragment);
}

Result<ResolveProgram> ResolveProgram::finish(Program program) {
    STIPPLE_CHECK(checkProgram(program));
    ResolveProgram made;
    auto at = [&](const char* name) { return glGetUniformLocation(program.id(), name); };
    made.colour = at("uColour");
    made.depth = at("uDepth");
    made.background = at("uBackground");
    made.nearBits = at("uNearBits");
    made.depthShift = at("uDepthShift");
    made.neighbours = at("uNeighbours");
    made.offsets = at("uOffsets");
    made.power = at("uPower");
    made.program = std::move(program);
    return made;
}

void ResolveProgram::useFor(const RasterFrame& frame, const EdlSetup& edl,
                            const std::array<std::uint8_t, 3>& backgroundColour) const {
    glUseProgram(program.id());
    glUniform1i(colour, 0);
    glUniform1i(depth, 1);
    glUniform3f(background, backgroundColour[0] / 255.0f, backgroundColour[1] / 255.0f,
                backgroundColour[2] / 255.0f);
    glUniform1ui(nearBits, frame.nearBits);
    glUniform1i(depthShift, frame.depthShift);
    glUniform1i(neighbours, edl.enabled ? edl.neighbours : 0);
    if (edl.enabled)
        glUniform2iv(offsets, edl.neighbours, edl.offsets[0].data());
    glUniform1f(power, edl.power);
}

} // namespace stipple::gles
