// What a program on node-mavlink asks of a rover, told as JSON: node node_client.mjs PORT
import { createSocket } from 'node:dgram'
import { once } from 'node:events'
import { PassThrough } from 'node:stream'
import { MavLinkPacketParser, MavLinkPacketSplitter, MavLinkProtocolV2, ardupilotmega, common, minimal, standard } from 'node-mavlink'

const KNOWN = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY, ...ardupilotmega.REGISTRY }
const messages = { ...minimal, ...standard, ...common, ...ardupilotmega }
const PATIENCE = 10_000

const socket = createSocket('udp4')
const bytes = new PassThrough()
const packets = bytes.pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser())
const protocol = new MavLinkProtocolV2(255, 190)
let rover, sequence = 0

socket.on('message', (data, from) => {
  rover = from
  bytes.write(data)
})

function heard(kind) {
  return new Promise((resolve, reject) => {
    const late = setTimeout(() => reject(new Error(`no ${kind.MSG_NAME}`)), PATIENCE)
    packets.on('data', function take(packet) {
      if (packet.header.msgid !== kind.MSG_ID) return
      packets.off('data', take)
      clearTimeout(late)
      resolve(packet.protocol.data(packet.payload, KNOWN[kind.MSG_ID]))
    })
  })
}

function ask(message, kind) {
  const answer = heard(kind)
  message.targetSystem = message.targetComponent = 1
  socket.send(protocol.serialize(message, sequence++ % 256), rover.port, rover.address)
  return answer
}

function command(number, ...numbers) {
  const message = new messages.CommandLong()
  message.command = number
  numbers.forEach((each, index) => { message[`_param${index + 1}`] = each })
  return message
}

function list(kind) {
  return Object.assign(new messages.MissionRequestList(), { missionType: kind })
}

socket.bind(Number(process.argv[2]), '127.0.0.1')
await once(socket, 'message')
const heartbeat = await heard(messages.Heartbeat)
const position = await heard(messages.GlobalPositionInt)
const told = {
  type: heartbeat.type,
  latitude: position.lat,
  longitude: position.lon,
  version: (await ask(command(512, 148), messages.AutopilotVersion)).flightSwVersion,
  oldVersion: (await ask(new messages.AutopilotVersionRequest(), messages.AutopilotVersion)).flightSwVersion,
  home: (await ask(command(410), messages.HomePosition)).latitude,
  parameters: (await ask(new messages.ParamRequestList(), messages.ParamValue)).paramCount,
  mission: (await ask(list(0), messages.MissionCount)).count,
  fence: (await ask(list(1), messages.MissionCount)).missionType,
  rally: (await ask(list(2), messages.MissionCount)).missionType,
  other: (await ask(command(2510), messages.CommandAck)).result,
  stream: (await ask(new messages.RequestDataStream(), messages.DataStream)).onOff,
}
console.log(JSON.stringify(told))
socket.close()
process.exit()
