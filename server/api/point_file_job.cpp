#include "server/api/point_file_job.hpp"

#include "converter/export/format_sink.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

constexpr const char* countField = "Stipple-Point-Count";

Error tooMany(const char* what, std::uint64_t count, std::uint64_t most) {
    return {ErrorCode::limitExceeded,
            cat("the answer would have ", count, " ", what, ", and at most ", most,
                " are given to one request; ask for less: a smaller region, a spacing, a limit"),
            "", ""};
}

// The body of the answer, whose head goes before its first byte.
class BodySink final : public ByteSink {
  public:
    BodySink(AnswerWriter& writer, HttpResponse head, std::uint64_t maxBytes)
        : writer_(writer), head_(std::move(head)), maxBytes_(maxBytes) {}
    Status finish() override { return begin(); } // also of nothing
    std::string name() const override { return "the answer"; }

  private:
    Status begin() {
        if (hasBegun_)
            return {};
        hasBegun_ = true;
        return writer_.begin(std::move(head_));
    }
    Status put(ByteSpan bytes) override {
        if (sizeBytes() + bytes.size() > maxBytes_)
            return tooMany("bytes", sizeBytes() + bytes.size(), maxBytes_);
        STIPPLE_CHECK(begin());
        return writer_.write(bytes);
    }

    AnswerWriter& writer_;
    HttpResponse head_;
    std::uint64_t maxBytes_;
    bool hasBegun_ = false;
};

// Ends a file that grows beyond what an answer may have.
class BoundedSink final : public ByteSink {
  public:
    BoundedSink(std::unique_ptr<ByteSink> to, std::uint64_t maxBytes)
        : to_(std::move(to)), maxBytes_(maxBytes) {}
    bool canOverwrite() const override { return to_->canOverwrite(); }
    Status overwrite(std::uint64_t offset, ByteSpan bytes) override { return to_->overwrite(offset, bytes); }
    Status finish() override { return to_->finish(); }
    std::string name() const override { return to_->name(); }

  private:
    Status put(ByteSpan bytes) override {
        if (sizeBytes() + bytes.size() > maxBytes_)
            return tooMany("bytes", sizeBytes() + bytes.size(), maxBytes_);
        return to_->append(bytes);
    }

    std::unique_ptr<ByteSink> to_;
    std::uint64_t maxBytes_;
};

class PointFileWriter {
  public:
    PointFileWriter(const PointFile& file, AnswerWriter& writer)
        : file_(file), writer_(writer), gate_(&writer.isStopped()), source_(file.cloud->openSource()),
          reader_(CloudReader::over(*source_, file.cloud->header, file.cloud->metadata)),
          input_{file.metadata, file.attributes} {
        walk_.threads = file.limits.threads;
        walk_.limit = file.request.limit;
        walk_.gate = &gate_;
    }

    Status write() {
        STIPPLE_CHECK(checkPoints());
        bool isFile = needsOverwriting(file_.format);
        STIPPLE_TRY(plan, planFormat(file_.format, isFile, *reader_, name_, file_.filter, input_, walk_));
        if (plan.pointCount)
            STIPPLE_CHECK(checkBytes(*plan.pointCount));
        return isFile ? writeFile(plan) : writeBody(plan);
    }

  private:
    // Most are told by the hierarchy; only where that leaves it open, points are counted.
    Status checkPoints() {
        const std::uint64_t most = file_.limits.maxPoints;
        if (walk_.limit > 0 && walk_.limit <= most)
            return {};
        STIPPLE_TRY(tally, tallyNodes(*reader_, file_.filter, walk_));
        if (tally.points <= most)
            return {};
        STIPPLE_TRY(count, countPoints(*reader_, name_, file_.filter, walk_));
        return count <= most ? Status() : Status(tooMany("points", count, most));
    }

    // What a binary file has at least; CSV is seldom smaller.
    Status checkBytes(std::uint64_t points) {
        constexpr std::uint64_t positionBytes = 12;
        std::uint64_t bytes = points * (positionBytes + input_.schema().bytesPerPoint());
        if (file_.format == ExportFormat::laz || bytes <= file_.limits.maxBytes)
            return {};
        return tooMany("bytes", bytes, file_.limits.maxBytes);
    }

    Result<std::uint64_t> walkInto(const FormatPlan& plan, std::unique_ptr<ByteSink> bytes) {
        STIPPLE_TRY(to, openFormatSink(plan, std::move(bytes), input_));
        STIPPLE_TRY(counters, walkPoints(*reader_, name_, file_.filter, input_.attributes, *to.sink, walk_));
        STIPPLE_CHECK(to.sink->finish());
        return counters.pointsTaken;
    }

    Status writeBody(const FormatPlan& plan) {
        HttpResponse head = file_.head;
        if (plan.pointCount)
            head.set(countField, std::to_string(*plan.pointCount));
        auto points =
            walkInto(plan, std::make_unique<BodySink>(writer_, std::move(head), file_.limits.maxBytes));
        return points ? Status() : Status(points.error());
    }

    // Sent once it is complete, by the server's threads: the job is over then.
    Status writeFile(const FormatPlan& plan) {
        auto opened = ScratchSink::open(file_.scratch);
        if (!opened)
            return noRoom(opened.error());
        ScratchSink::FilePlace place = (*opened)->place();
        std::shared_ptr<ScratchSpace> space = file_.scratch;
        auto points =
            walkInto(plan, std::make_unique<BoundedSink>(*std::move(opened), file_.limits.maxBytes));
        if (!points)
            return points.error().code == ErrorCode::writeFailed ||
                           points.error().what == ScratchSpace::noRoomText
                       ? noRoom(points.error())
                       : Status(points.error());
        HttpResponse response = file_.head;
        response.set(countField, std::to_string(*points));
        response.body.push_back(FileSlice{*place, 0, (*place)->identity().sizeBytes});
        writer_.answer(std::move(response));
        return {};
    }

    // The server's fault, and for a while only. Paths of this machine stay here.
    Status noRoom(const Error& error) {
        if (error.code == ErrorCode::cancelled)
            return error;
        HttpResponse problem = problemResponse(503, "there is no room for a temporary file now");
        problem.set("Retry-After", "10");
        writer_.answer(std::move(problem));
        return {};
    }

    const PointFile& file_;
    AnswerWriter& writer_;
    const StopGate gate_;
    const std::string name_ = "the cloud";
    std::unique_ptr<ByteSource> source_;
    std::unique_ptr<CloudReader> reader_;
    SinkInput input_;
    WalkOptions walk_;
};

} // namespace

Status writePointFile(const PointFile& file, AnswerWriter& writer) {
    return PointFileWriter(file, writer).write();
}

} // namespace stipple::server
