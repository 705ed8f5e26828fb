import DOMPurify from 'dompurify';
import { Marked } from 'marked';

/** What a text in Markdown may become: no scripts, no styles, no forms, nothing that is fetched from elsewhere but by a click. */
const allowedTags = [
    'a', 'b', 'blockquote', 'br', 'code', 'del', 'em', 'h1', 'h2', 'h3', 'h4', 'hr', 'i', 'img', 'li', 'ol', 'p', 'pre',
    'strong', 'sub', 'sup', 'table', 'tbody', 'td', 'th', 'thead', 'tr', 'ul',
];
const allowedAttributes = ['href', 'src', 'alt', 'title', 'start', 'align'];

/** HTML in a text is shown as text. */
const markdown = new Marked({ renderer: { html: ({ text }) => escaped(text) } });

function escaped(text: string): string {
    return text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;').replaceAll('"', '&quot;');
}

/** As elements. Links open in a window of their own, which knows nothing of this page. */
export function renderMarkdown(text: string): DocumentFragment {
    const fragment = DOMPurify.sanitize(markdown.parse(text, { async: false }), {
        ALLOWED_TAGS: allowedTags,
        ALLOWED_ATTR: allowedAttributes,
        ALLOW_DATA_ATTR: false,
        RETURN_DOM_FRAGMENT: true,
    });
    for (const link of fragment.querySelectorAll('a')) {
        link.target = '_blank';
        link.rel = 'noopener noreferrer';
    }
    return fragment;
}
