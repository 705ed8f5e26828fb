#include "converter/export/json_sink.hpp"

#include "shared/base/text.hpp"
#include "shared/sinks/row_text.hpp"

#include <nlohmann/json.hpp>

namespace stipple {

namespace {

class JsonSink final : public PointSink {
  public:
    JsonSink(std::unique_ptr<ByteSink> to, const SinkInput& input) : to_(std::move(to)), rows_(input) {}

    Status writeHead(const std::string& head) {
        nlohmann::json names = rows_.columnNames();
        std::string columns = names.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        return append(cat("{", head, "\"columns\":", columns, ",\n\"points\":["));
    }

    // Rows, each with a line end before and a comma behind it.
    Result<EncodedPoints> encode(PointBatch batch) const override {
        std::string text;
        text.reserve(batch.size() * (rows_.expectedRowBytes() + 3));
        for (std::size_t row = 0; row < batch.size(); ++row) {
            char before = '[';
            text += '\n';
            rows_.forEachValue(batch, row, [&](const auto& appendValue) {
                text += before;
                before = ',';
                std::size_t at = text.size();
                appendValue(text);
                if (!isNumber(std::string_view(text).substr(at)))
                    text.replace(at, std::string::npos, "null");
            });
            text += "],";
        }
        return EncodedPoints{batch.size(), Bytes(text.begin(), text.end()), {}};
    }

    // The comma behind the last row waits for a row to follow.
    Status write(EncodedPoints points) override {
        if (points.bytes.empty())
            return {};
        if (hasRows_)
            STIPPLE_CHECK(append(","));
        hasRows_ = true;
        return to_->append(ByteSpan(points.bytes).first(points.bytes.size() - 1));
    }

    Status finish() override {
        STIPPLE_CHECK(append("\n]}\n"));
        return to_->finish();
    }

  private:
    // Not nothing, "nan" or "inf".
    static bool isNumber(std::string_view text) {
        std::size_t digit = text.starts_with('-') ? 1 : 0;
        return text.size() > digit && text[digit] >= '0' && text[digit] <= '9';
    }
    Status append(const std::string& text) {
        return to_->append(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    }

    std::unique_ptr<ByteSink> to_;
    RowText rows_;
    bool hasRows_ = false;
};

} // namespace

Result<std::unique_ptr<PointSink>> jsonSink(std::unique_ptr<ByteSink> to, const SinkInput& input,
                                            const std::string& head) {
    auto sink = std::make_unique<JsonSink>(std::move(to), input);
    STIPPLE_CHECK(sink->writeHead(head));
    return std::unique_ptr<PointSink>(std::move(sink));
}

} // namespace stipple
