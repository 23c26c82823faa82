#include "render/report/document/pdf_tags.hpp"

#include "estimator/common/error.hpp"
#include "render/report/document/html.hpp"

#include <fmt/format.h>
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFObjectHandle.hh>
#include <qpdf/QPDFPageDocumentHelper.hh>
#include <qpdf/QPDFWriter.hh>

#include <exception>
#include <memory>

namespace macadam {
namespace {

constexpr int deepest = 100; // levels of a report's structure: far fewer

/// Marks what is drawn outside of marked content as an artifact: rules, running heads, page
/// numbers, repeated headings of tables.
class ArtifactMarker : public QPDFObjectHandle::TokenFilter {
public:
    void handleToken(const QPDFTokenizer::Token& token) override {
        const bool is_operator = token.getType() == QPDFTokenizer::tt_word ||
                                 token.getType() == QPDFTokenizer::tt_inline_image;
        if (!is_operator) {
            operands_ += token.getRawValue();
            return;
        }
        const auto& name = token.getValue();
        const bool begins = name == "BDC" || name == "BMC";
        if (depth_ == 0 && begins && in_artifact_) {
            write("\nEMC\n");
            in_artifact_ = false;
        } else if (depth_ == 0 && !begins && !in_artifact_) {
            write("\n/Artifact BMC\n");
            in_artifact_ = true;
        }
        depth_ += begins ? 1 : name == "EMC" ? -1 : 0;
        write(operands_);
        operands_.clear();
        writeToken(token);
    }

    void handleEOF() override {
        write(operands_);
        if (in_artifact_) {
            write("\nEMC\n");
        }
    }

private:
    std::string operands_; ///< with the blanks between them
    int depth_ = 0;
    bool in_artifact_ = false;
};

/// Elements of the structure that need more than Cairo writes, in reading order.
struct Elements {
    std::vector<QPDFObjectHandle> all;
    std::vector<QPDFObjectHandle> figures;
    std::vector<QPDFObjectHandle> headings;
};

void collect(QPDFObjectHandle element, Elements& found, int depth) {
    if (depth > deepest || !element.isDictionary()) {
        return;
    }
    auto kind = element.getKey("/S");
    if (kind.isName()) {
        found.all.push_back(element);
    }
    if (kind.isName() && kind.getName() == "/Figure") {
        found.figures.push_back(element);
    }
    if (kind.isName() && kind.getName() == "/TH") {
        found.headings.push_back(element);
    }
    auto kids = element.getKey("/K");
    if (kids.isArray()) {
        for (int i = 0; i < kids.getArrayNItems(); ++i) {
            collect(kids.getArrayItem(i), found, depth + 1);
        }
    } else {
        collect(kids, found, depth + 1);
    }
}

void expect_as_many(std::size_t there, std::size_t expected, const char* what) {
    if (there != expected) {
        throw InputError{fmt::format(
            "the PDF has {} {}, expected {}; another version of Cairo may order them otherwise",
            there,
            what,
            expected)};
    }
}

void describe_elements(QPDF& pdf, const PdfAccess& access) {
    Elements found;
    collect(pdf.getRoot().getKey("/StructTreeRoot"), found, 0);
    expect_as_many(found.figures.size(), access.figures.size(), "figures");
    expect_as_many(found.headings.size(), access.heading_scope.size(), "headings of tables");
    expect_as_many(found.all.size(), access.elements, "elements");
    for (const auto& [number, text] : access.spoken) {
        found.all[number].replaceKey("/ActualText", QPDFObjectHandle::newUnicodeString(text));
    }
    for (std::size_t i = 0; i < found.figures.size(); ++i) {
        found.figures[i].replaceKey("/Alt", QPDFObjectHandle::newUnicodeString(access.figures[i]));
    }
    for (std::size_t i = 0; i < found.headings.size(); ++i) {
        found.headings[i].replaceKey("/A",
                                     QPDFObjectHandle::parse(fmt::format(
                                         "<< /O /Table /Scope /{} >>", access.heading_scope[i])));
    }
}

void describe_links(QPDFPageObjectHelper page) {
    auto annotations = page.getObjectHandle().getKey("/Annots");
    for (int i = 0; annotations.isArray() && i < annotations.getArrayNItems(); ++i) {
        auto link = annotations.getArrayItem(i);
        auto action = link.getKey("/A");
        auto uri = action.isDictionary() ? action.getKey("/URI") : QPDFObjectHandle::newNull();
        auto place = link.getKey("/Dest");
        link.replaceKey("/Contents",
                        uri.isString()     ? uri
                        : place.isString() ? place
                                           : QPDFObjectHandle::newUnicodeString("link"));
    }
}

/// Returns the document's metadata, which says that it claims PDF/UA.
std::string metadata_of(const PdfAccess& access) {
    return fmt::format(
        "<?xpacket begin=\"\xEF\xBB\xBF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF "
        "xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\"><rdf:Description "
        "rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" "
        "xmlns:pdfuaid=\"http://www.aiim.org/pdfua/ns/id/\"><pdfuaid:part>1</pdfuaid:part>"
        "<dc:title><rdf:Alt><rdf:li xml:lang=\"x-default\">{}</rdf:li></rdf:Alt></dc:title>"
        "<dc:language><rdf:Bag><rdf:li>{}</rdf:li></rdf:Bag></dc:language>"
        "</rdf:Description></rdf:RDF></x:xmpmeta>\n<?xpacket end=\"r\"?>",
        escaped(access.title),
        escaped(access.language));
}

void describe_document(QPDF& pdf, const PdfAccess& access) {
    auto root = pdf.getRoot();
    root.replaceKey("/Lang", QPDFObjectHandle::newUnicodeString(access.language));
    root.replaceKey("/ViewerPreferences", QPDFObjectHandle::parse("<< /DisplayDocTitle true >>"));
    auto metadata = QPDFObjectHandle::newStream(&pdf, metadata_of(access));
    metadata.getDict().replaceKey("/Type", QPDFObjectHandle::newName("/Metadata"));
    metadata.getDict().replaceKey("/Subtype", QPDFObjectHandle::newName("/XML"));
    root.replaceKey("/Metadata", metadata);
}

} // namespace

std::string accessible_pdf(const std::string& pdf, const PdfAccess& access) {
    try {
        QPDF document;
        document.setSuppressWarnings(true);
        document.processMemoryFile("report", pdf.data(), pdf.size());
        describe_document(document, access);
        describe_elements(document, access);
        for (auto& page : QPDFPageDocumentHelper{document}.getAllPages()) {
            page.addContentTokenFilter(std::make_shared<ArtifactMarker>());
            page.getObjectHandle().replaceKey("/Tabs", QPDFObjectHandle::newName("/S"));
            describe_links(page);
        }
        QPDFWriter writer{document};
        writer.setOutputMemory();
        writer.setDeterministicID(true);
        writer.setMinimumPDFVersion("1.7");
        writer.write();
        const auto buffer = writer.getBufferSharedPointer();
        return {reinterpret_cast<const char*>(buffer->getBuffer()), // NOLINT(*-reinterpret-cast)
                buffer->getSize()};
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& error) { // of libqpdf
        throw InputError{fmt::format("cannot describe the structure of the PDF: {}", error.what())};
    }
}

} // namespace macadam
