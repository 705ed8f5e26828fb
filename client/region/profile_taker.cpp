#include "client/region/point_taker.hpp"
#include "shared/format/picture_attributes.hpp"

#include <nlohmann/json.hpp>

#include <array>

namespace stipple {

namespace {

using nlohmann::json;
namespace names = attribute_names;

constexpr std::uint32_t grey = 0xffc8c8c8;

// One number of an attribute, whatever its type is; 0 where the cloud lacks it.
class Column {
  public:
    Column(const Schema& schema, std::string_view name, std::vector<int>& attributes) {
        int index = schema.find(name);
        if (index < 0 || schema.attributes[static_cast<std::size_t>(index)].components != 1)
            return;
        type_ = schema.attributes[static_cast<std::size_t>(index)].type;
        place_ = static_cast<std::ptrdiff_t>(attributes.size());
        attributes.push_back(index);
    }
    bool isThere() const { return place_ >= 0; }
    std::uint32_t at(const PointBatch& batch, std::size_t row) const {
        if (!isThere())
            return 0;
        const std::uint8_t* from =
            batch.columns[static_cast<std::size_t>(place_)].data() + row * attributeTypeSize(type_);
        switch (attributeTypeSize(type_)) {
        case 1:
            return *from;
        case 2:
            return loadLe<std::uint16_t>(from);
        default:
            return loadLe<std::uint32_t>(from);
        }
    }

  private:
    std::ptrdiff_t place_ = -1;
    AttributeType type_ = AttributeType::u8;
};

class ProfileTaker final : public PointTaker {
  public:
    ProfileTaker(const Metadata& metadata, std::shared_ptr<Pieces> pieces)
        : metadata_(metadata),
          pieces_(std::move(pieces)), colour_{Column(metadata->schema, names::red, attributes_),
                                              Column(metadata->schema, names::green, attributes_),
                                              Column(metadata->schema, names::blue, attributes_)},
          class_(metadata->schema, names::classification, attributes_),
          return_(metadata->schema, names::returnNumber, attributes_),
          intensity_(metadata->schema, names::intensity, attributes_) {
        auto stored = static_cast<int>(metadata->schema.attributes.size());
        place_ = attributes_.size();
        attributes_.insert(attributes_.end(), {stored, stored + 1}); // station, offset
    }

    Status take(PointBatch batch) override {
        if (batch.size() == 0)
            return {};
        points_ += batch.size();
        ByteWriter out;
        out.write(static_cast<std::uint32_t>(batch.size()));
        out.write(std::uint32_t{0});
        out.writeBytes(batch.columns[place_]);
        out.writeBytes(batch.columns[place_ + 1]);
        for (int axis = 0; axis < 3; ++axis)
            for (const Vec3i& position : batch.positions)
                out.write(metadata_->grid.toWorld(position)[axis]);
        for (std::size_t row = 0; row < batch.size(); ++row)
            out.write(colourAt(batch, row));
        for (std::size_t row = 0; row < batch.size(); ++row)
            out.write(static_cast<std::uint32_t>((class_.at(batch, row) & 0xff) |
                                                 (return_.at(batch, row) & 0xff) << 8));
        for (std::size_t row = 0; row < batch.size(); ++row)
            out.write(static_cast<float>(intensity_.at(batch, row)));
        pieces_->append(out.take());
        return {};
    }
    Result<json> finish() override { return json{{"points", points_}}; }
    const std::vector<int>& attributes() const override { return attributes_; }

  private:
    std::uint32_t colourAt(const PointBatch& batch, std::size_t row) const {
        if (!colour_[0].isThere() || !colour_[1].isThere() || !colour_[2].isThere())
            return grey;
        std::uint32_t shift = metadata_->colourIs8Bit ? 0 : 8, colour = 0xff000000;
        for (std::uint32_t channel = 0; channel < 3; ++channel)
            colour |= ((colour_[channel].at(batch, row) >> shift) & 0xff) << (8 * channel);
        return colour;
    }

    Metadata metadata_;
    std::shared_ptr<Pieces> pieces_;
    std::vector<int> attributes_; // before the columns, which add to it
    std::array<Column, 3> colour_;
    Column class_, return_, intensity_;
    std::size_t place_ = 0; // of the station's column
    std::uint64_t points_ = 0;
};

} // namespace

Result<std::unique_ptr<PointTaker>> profileTaker(const Metadata& metadata, const CloudFilter& filter,
                                                 std::shared_ptr<Pieces> pieces) {
    if (!filter.hasCorridor())
        return Error{ErrorCode::invalidArgument, say("a profile needs a line and a width"), "region", ""};
    return std::unique_ptr<PointTaker>(std::make_unique<ProfileTaker>(metadata, std::move(pieces)));
}

} // namespace stipple
