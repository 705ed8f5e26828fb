#include "converter/build/compare.hpp"

#include "converter/build/morton_order.hpp"
#include "converter/build/tile.hpp"
#include "shared/base/text.hpp"

#include <cstring>

namespace stipple {

namespace {
constexpr std::size_t maxSentences = 10;

BoxI boundsOf(const PointStore& store) {
    BoxI bounds;
    for (std::size_t i = 0; i < store.size(); ++i)
        bounds.extend(store.position(i));
    return bounds;
}

std::string hexBytes(const std::uint8_t* bytes, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) {
        text += "0123456789abcdef"[bytes[i] >> 4];
        text += "0123456789abcdef"[bytes[i] & 15];
    }
    return text;
}

template <class T>
std::string number(const std::uint8_t* bytes) {
    return cat(loadLe<T>(bytes));
}
std::string valueText(const Attribute& attribute, const std::uint8_t* bytes) {
    if (attribute.components > 1)
        return hexBytes(bytes, attribute.size());
    switch (attribute.type) {
    case AttributeType::u8:
        return cat(static_cast<int>(*bytes));
    case AttributeType::i8:
        return cat(static_cast<int>(static_cast<std::int8_t>(*bytes)));
    case AttributeType::u16:
        return number<std::uint16_t>(bytes);
    case AttributeType::i16:
        return number<std::int16_t>(bytes);
    case AttributeType::u32:
        return number<std::uint32_t>(bytes);
    case AttributeType::i32:
        return number<std::int32_t>(bytes);
    case AttributeType::u64:
        return number<std::uint64_t>(bytes);
    case AttributeType::i64:
        return number<std::int64_t>(bytes);
    case AttributeType::f32:
        return number<float>(bytes);
    case AttributeType::f64:
        return number<double>(bytes);
    }
    return {};
}

// Walks both sides in Morton order, one position after the other.
class Comparer {
  public:
    Comparer(const PointStore& file, const PointStore& inputs, const Grid& grid, const Schema& schema)
        : file_(file), inputs_(inputs), grid_(grid), schema_(schema) {}

    Result<Comparison> run(int threads, const std::atomic<bool>* stop) {
        result_.filePoints = file_.size();
        result_.inputPoints = inputs_.size();
        result_.changedPerAttribute.assign(schema_.attributes.size(), 0);
        BoxI bounds = boundsOf(file_);
        bounds.extend(boundsOf(inputs_));
        STIPPLE_TRY(cube, rootCubeOf(bounds));
        STIPPLE_TRY(fileOrder, mortonOrder(file_, cube, threads, stop));
        STIPPLE_TRY(inputOrder, mortonOrder(inputs_, cube, threads, stop));
        std::size_t f = 0, i = 0;
        while (f < fileOrder.size() || i < inputOrder.size()) {
            int order = f == fileOrder.size()    ? 1
                        : i == inputOrder.size() ? -1
                                                 : compareMorton(file_.position(fileOrder[f]) - cube.min,
                                                                 inputs_.position(inputOrder[i]) - cube.min);
            if (order < 0)
                noteSurplus(fileOrder[f++]);
            else if (order > 0)
                noteMissing(inputOrder[i++]);
            else
                comparePosition(fileOrder, f, inputOrder, i);
        }
        return std::move(result_);
    }

  private:
    using Order = std::vector<std::uint32_t>;

    // All points of one position: equal ones cancel, the rest are paired in order.
    void comparePosition(const Order& fileOrder, std::size_t& f, const Order& inputOrder, std::size_t& i) {
        Vec3i position = file_.position(fileOrder[f]);
        fileRest_.clear();
        inputRest_.clear();
        auto fileHas = [&] { return f < fileOrder.size() && file_.position(fileOrder[f]) == position; };
        auto inputHas = [&] { return i < inputOrder.size() && inputs_.position(inputOrder[i]) == position; };
        std::size_t bytes = file_.rowBytes() - sizeof(Vec3i);
        while (fileHas() && inputHas()) {
            int order = std::memcmp(file_.attributes(fileOrder[f]), inputs_.attributes(inputOrder[i]), bytes);
            if (order == 0) {
                ++result_.equalPoints;
                ++f;
                ++i;
            } else if (order < 0) {
                fileRest_.push_back(fileOrder[f++]);
            } else {
                inputRest_.push_back(inputOrder[i++]);
            }
        }
        while (fileHas())
            fileRest_.push_back(fileOrder[f++]);
        while (inputHas())
            inputRest_.push_back(inputOrder[i++]);
        std::size_t pairs = std::min(fileRest_.size(), inputRest_.size());
        for (std::size_t p = 0; p < pairs; ++p)
            noteChanged(fileRest_[p], inputRest_[p]);
        for (std::size_t p = pairs; p < fileRest_.size(); ++p)
            noteSurplus(fileRest_[p]);
        for (std::size_t p = pairs; p < inputRest_.size(); ++p)
            noteMissing(inputRest_[p]);
    }

    void noteChanged(std::uint32_t filePoint, std::uint32_t inputPoint) {
        ++result_.changed;
        std::string differences;
        const std::uint8_t *ours = file_.attributes(filePoint), *theirs = inputs_.attributes(inputPoint);
        for (std::size_t a = 0; a < schema_.attributes.size(); ++a) {
            const Attribute& attribute = schema_.attributes[a];
            if (std::memcmp(ours, theirs, attribute.size()) != 0) {
                ++result_.changedPerAttribute[a];
                if (result_.first.size() < maxSentences)
                    differences += cat(differences.empty() ? "" : ", ", attribute.name, " is ",
                                       valueText(attribute, ours), ", not ", valueText(attribute, theirs));
            }
            ours += attribute.size();
            theirs += attribute.size();
        }
        say(file_.position(filePoint), differences);
    }
    void noteSurplus(std::uint32_t filePoint) {
        ++result_.surplus;
        say(file_.position(filePoint), "the file has a point that is not in the inputs");
    }
    void noteMissing(std::uint32_t inputPoint) {
        ++result_.missing;
        say(inputs_.position(inputPoint), "a point of the inputs is not in the file");
    }
    void say(Vec3i position, const std::string& what) {
        if (result_.first.size() >= maxSentences)
            return;
        Vec3d world = grid_.toWorld(position);
        char text[120];
        std::snprintf(text, sizeof text, "at (%.10g, %.10g, %.10g): ", world.x, world.y, world.z);
        result_.first.push_back(text + what);
    }

    const PointStore &file_, &inputs_;
    const Grid& grid_;
    const Schema& schema_;
    Comparison result_;
    std::vector<std::uint32_t> fileRest_, inputRest_;
};
} // namespace

Result<Comparison> comparePoints(const PointStore& file, const PointStore& inputs, const Grid& grid,
                                 const Schema& schema, int threads, const std::atomic<bool>* stop) {
    return Comparer(file, inputs, grid, schema).run(threads, stop);
}

} // namespace stipple
