#include "converter/build/input_parts.hpp"

#include "shared/base/text.hpp"

namespace stipple {

std::vector<PartRef> partsOf(const Scan& scan) {
    std::vector<PartRef> refs;
    for (std::size_t i = 0; i < scan.inputs.size(); ++i) {
        const std::vector<InputPart>& parts = scan.inputs[i].input->parts();
        for (std::size_t p = 0; p < parts.size(); ++p)
            refs.push_back({i, p, parts[p].points});
    }
    return refs;
}

Status readPart(const Scan& scan, const PartRef& ref, PartReader& reader,
                const std::function<Status(const PointBatch&)>& take) {
    const PointInput& input = *scan.inputs[ref.input].input;
    STIPPLE_TRY(stream, input.openPart(ref.part));
    std::uint64_t points = 0;
    for (;;) {
        STIPPLE_CHECK(stream->next(reader.raw));
        if (reader.raw.size() == 0)
            break;
        points += reader.raw.size();
        if (points > ref.points)
            return Error{ErrorCode::changed, "more points came than were counted when it was opened",
                         input.description().path, "try again when the file is complete"};
        STIPPLE_CHECK(take(toCloud(scan, ref.input, reader.raw, reader.mapped, reader.sums)));
    }
    reader.sums.reports[ref.input].add(stream->report());
    if (points < ref.points && stream->report().dropped() == 0)
        return Error{ErrorCode::changed,
                     cat(ref.points - points, " points fewer came than were counted when it was opened"),
                     input.description().path, "try again when the file is complete"};
    return {};
}

} // namespace stipple
