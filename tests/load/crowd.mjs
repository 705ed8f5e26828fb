// Many connections that behave badly, in a process of their own, so that it can be killed and does not slow down
// whoever measures.
//   node crowd.mjs PORT SCHEME KIND COUNT TARGET BYTES
// KIND  busy: keeps four requests for random 64 KiB under way    slow: reads 16 KiB a second of 64 MiB
//       unread: asks for 64 MiB and reads nothing                closed: the same, and closes its sending side
//       half: half a request's header, again whenever it is cut  (with https also) handshake: half a ClientHello
// Prints "ready" once all are connected and have sent; then one line a second: connections open, cut so far.
import net from 'node:net';
import tls from 'node:tls';
import { randomBelow } from './support.mjs';

const [port, scheme, kind, count, target, bytes] = process.argv.slice(2);
const large = 64 << 20;
let open = 0, cut = 0, sent = 0;

function request(size) {
    const first = randomBelow(Number(bytes) - size);
    return `GET ${target} HTTP/1.1\r\nHost: a\r\nRange: bytes=${first}-${first + size - 1}\r\n\r\n`;
}

function begin(socket) {
    if (kind === 'busy') {
        let received = 0;
        socket.on('data', (data) => {
            for (received += data.length; received >= 65536; received -= 65536) socket.write(request(65536));
        });
        socket.write(request(65536).repeat(4));
    } else if (kind === 'half') socket.write('GET / HTTP/1.1\r\nHost: a\r\nX');
    else if (kind === 'handshake') socket.write(Buffer.from('16030102000100', 'hex'));
    else {
        socket.pause();
        socket.write(request(large));
        if (kind === 'closed') socket.end();
        if (kind === 'slow') {
            const timer = setInterval(() => socket.read(16384), 1000);
            socket.on('close', () => clearInterval(timer));
        }
    }
}

function connect(i) {
    const where = { host: '127.0.0.1', port: Number(port), localAddress: `127.0.1.${1 + (i % 8)}`, rejectUnauthorized: false };
    const isTls = scheme === 'https' && kind !== 'handshake';
    const socket = isTls ? tls.connect({ ...where, socket: net.connect(where) }) : net.connect(where);
    socket.on('error', () => {});
    socket.on(isTls ? 'secureConnect' : 'connect', () => {
        ++open;
        begin(socket);
        if (++sent === Number(count)) console.log('ready');
        socket.on('close', () => {
            --open;
            ++cut;
            if (kind === 'half') setTimeout(() => connect(i), 10);
        });
    });
}

for (let i = 0; i < Number(count); ++i) {
    connect(i);
    if (i % 50 === 49) await new Promise((done) => setTimeout(done, 10));
}
setInterval(() => console.log(`${open} open, ${cut} cut`), 1000);
