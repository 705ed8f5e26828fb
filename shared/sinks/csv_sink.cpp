#include "shared/sinks/csv_sink.hpp"

#include "shared/sinks/row_text.hpp"

namespace stipple {

namespace {

std::string quoted(const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos)
        return name;
    std::string text = "\"";
    for (char c : name)
        text += c == '"' ? "\"\"" : std::string(1, c);
    return text + "\"";
}

class CsvSink final : public PointSink {
  public:
    CsvSink(std::unique_ptr<ByteSink> to, const SinkInput& input) : to_(std::move(to)), rows_(input) {}

    Status writeHeader() {
        std::string header;
        for (const std::string& name : rows_.columnNames())
            header.append(header.empty() ? "" : ",").append(quoted(name));
        return append(header + "\n");
    }

    Result<EncodedPoints> encode(PointBatch batch) const override {
        std::string text;
        text.reserve(batch.size() * rows_.expectedRowBytes());
        for (std::size_t row = 0; row < batch.size(); ++row) {
            bool isFirst = true;
            rows_.forEachValue(batch, row, [&](const auto& appendValue) {
                if (!isFirst)
                    text += ',';
                isFirst = false;
                appendValue(text);
            });
            text += '\n';
        }
        return EncodedPoints{batch.size(), Bytes(text.begin(), text.end()), {}};
    }

    Status write(EncodedPoints points) override { return to_->append(points.bytes); }
    Status finish() override { return to_->finish(); }

  private:
    Status append(const std::string& text) {
        return to_->append(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    }

    std::unique_ptr<ByteSink> to_;
    RowText rows_;
};

} // namespace

Result<std::unique_ptr<PointSink>> csvSink(std::unique_ptr<ByteSink> to, const SinkInput& input) {
    auto sink = std::make_unique<CsvSink>(std::move(to), input);
    STIPPLE_CHECK(sink->writeHeader());
    return std::unique_ptr<PointSink>(std::move(sink));
}

} // namespace stipple
